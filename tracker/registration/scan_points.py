"""The points of a scan that are fitted: without objects and loose bits, any first of them spread evenly."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
from scipy import sparse
from scipy.sparse.csgraph import connected_components
from scipy.spatial import KDTree

from tracker.capture.scan import Scan

Array = npt.NDArray[np.float64]
Mask = npt.NDArray[np.bool_]

GREEN = 20
"""[R17] section 3.1: a point is an object's where G > max(R, 20)."""

MAX_GREEN_SHARE = 0.7
"""If the colour rule would take more than this, the colours mean something else, and it is not used."""

MIN_PIECE_SHARE = 0.004
"""Connected pieces of a mesh with fewer of its points are dropped."""


SURFACE_POINTS = 6000
"""So many stand for the surface when vertices look for it."""


@dataclass(frozen=True, eq=False)
class ScanPoints:
    """Points that are fitted; any first n of them lie spread over the surface.

    Attributes:
        points: (N, 3) m.
        normals: (N, 3) unit; zero where unknown.
        whole: All points, where these are the first of more.
    """

    points: Array
    normals: Array
    whole: ScanPoints | None = None

    def first(self, count: int) -> ScanPoints:
        if count >= len(self.points):
            return self
        return ScanPoints(self.points[:count], self.normals[:count], self.whole or self)

    @cached_property
    def surface(self) -> ScanPoints:
        """Points enough to stand for the surface."""
        if self.whole is not None:
            return self.whole.surface
        return self.first(SURFACE_POINTS) if len(self.points) > SURFACE_POINTS else self

    @cached_property
    def tree(self) -> KDTree:
        return KDTree(self.points)

    def chosen(self, ids: npt.NDArray[np.integer]) -> ScanPoints:
        """Those of the points (n,)."""
        return ScanPoints(np.ascontiguousarray(self.points[ids]), np.ascontiguousarray(self.normals[ids]))

    def mirrored(self) -> ScanPoints:
        """The points seen in the mirror x = 0."""
        flip = np.array([-1.0, 1.0, 1.0])
        return ScanPoints(self.points * flip, self.normals * flip)


def find_hand_points(scan: Scan, use_colors: bool = True) -> tuple[Mask, list[str]]:
    """Points (N,) that may belong to a hand, and what was left out and why."""
    keep = np.asarray(np.isfinite(np.concatenate([scan.points, scan.normals], axis=1)).all(axis=1))
    notes = [] if keep.all() else [f"{int((~keep).sum())} points are not finite"]
    if use_colors and scan.colors is not None:
        red, green = scan.colors[:, 0], scan.colors[:, 1]
        is_object = (green > red) & (green > GREEN)
        share = float(is_object.mean()) if len(is_object) else 0.0
        if share > MAX_GREEN_SHARE:
            notes.append(f"{100 * share:.0f} % of the points are green: the colour rule for objects was not used")
        elif is_object.any():
            keep &= ~is_object
            notes.append(f"{int(is_object.sum())} green points are taken for an object")
    if scan.faces is not None and keep.any():
        pieces = _find_pieces(scan, keep)
        sizes = np.bincount(pieces[keep], minlength=pieces.max() + 1)
        is_small = sizes < MIN_PIECE_SHARE * keep.sum()
        if is_small.any() and not is_small.all():
            loose = keep & is_small[pieces]
            if loose.any():
                keep &= ~loose
                notes.append(f"{int(loose.sum())} points lie in {int((sizes[is_small] > 0).sum())} loose bits")
    return keep, notes


def arrange_points(scan: Scan, keep: Mask, count: int) -> ScanPoints:
    """At most `count` of the points of the mask (N,), drawn by the area they stand for."""
    ids = np.flatnonzero(keep)
    areas = np.ones(len(ids))
    if scan.faces is not None and len(scan.faces):
        corners = scan.points[scan.faces]
        area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
        all_areas = np.bincount(scan.faces.ravel(), np.repeat(area, 3), minlength=len(scan.points))
        areas = np.maximum(all_areas[ids], 1e-3 * max(float(all_areas.mean()), 1e-18))
    keys = np.random.default_rng(1).exponential(size=len(ids)) / areas
    chosen = ids[np.argsort(keys, kind="stable")[:count]]
    return ScanPoints(np.ascontiguousarray(scan.points[chosen]), np.ascontiguousarray(scan.normals[chosen]))


def _find_pieces(scan: Scan, keep: Mask) -> npt.NDArray[np.int32]:
    assert scan.faces is not None
    faces = scan.faces[keep[scan.faces].all(axis=1)]
    rows, columns = faces[:, [0, 1]].ravel(), faces[:, [1, 2]].ravel()
    graph = sparse.coo_matrix((np.ones(len(rows), dtype=np.int8), (rows, columns)), (len(keep), len(keep)))
    return connected_components(graph, directed=False)[1]
