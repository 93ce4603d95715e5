"""Convex hulls of the bones of a model, the low resolution of [T16] Fig. 9."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.spatial import ConvexHull, QhullError

from tracker.model.articulated import ArticulatedModel

Array = npt.NDArray[np.float64]

MAX_VERTICES = 160
"""Of a hull; the extreme points in that many directions are kept of a rounder one.

A ball loses up to 1 % of its radius by it; fewer directions leave facets that it rolls on."""

MIN_HALF_THICKNESS = 0.0005
"""m; a flat part is given this much on either side, so that it has an inside."""


@dataclass(frozen=True)
class BoneHull:
    """What follows one bone, as a convex body.

    Attributes:
        bone: Of the model.
        vertices: (H, 3) rest pose, model axes, from `center`, m.
        center: (3,) centroid of the hull, rest pose, model frame, m.
        volume: m³.
        planes: (P, 4) of its faces, rest pose, model axes, from `center`: n · x + d is at most 0 inside, m.
    """

    bone: int
    vertices: Array
    center: Array
    volume: float
    planes: Array

    @property
    def radius(self) -> float:
        """Of the sphere around `center` that holds the hull, m."""
        return float(np.linalg.norm(self.vertices, axis=1).max())

    @property
    def inertia_per_mass(self) -> Array:
        """(3,) moments about the model's axes of a box of this size, m², as Bullet takes for any hull."""
        squares = np.ptp(self.vertices, axis=0) ** 2
        return (squares.sum() - squares) / 12.0


def find_bone_hulls(model: ArticulatedModel) -> tuple[BoneHull, ...]:
    """The hulls of the bones that are the heaviest of some vertex of the surface, [T16] §3.2.6."""
    used = np.unique(model.faces)
    heaviest = np.argmax(model.skinning_weights[used], axis=1)
    return tuple(
        build_hull(bone, model.vertices[used[heaviest == bone]])
        for bone in range(model.skeleton.num_bones)
        if np.any(heaviest == bone)
    )


def build_hull(bone: int, points: Array) -> BoneHull:
    """The convex hull of points (N, 3), m; a flat or tiny set is thickened."""
    assert points.ndim == 2 and points.shape[1] == 3 and len(points) > 0
    try:
        hull = ConvexHull(points)
    except (QhullError, ValueError):
        around = MIN_HALF_THICKNESS * np.concatenate([np.eye(3), -np.eye(3)])
        points = (points[:, None] + around).reshape(-1, 3)
        hull = ConvexHull(points)
    corners = _thin_out(points[hull.vertices])
    if len(corners) < len(hull.vertices):
        points = corners
        hull = ConvexHull(points)
    center = _centroid(points, hull)
    planes = np.unique(np.round(hull.equations, 9), axis=0)
    planes[:, 3] += planes[:, :3] @ center
    return BoneHull(bone, points[np.sort(hull.vertices)] - center, center, float(hull.volume), planes)


def _thin_out(points: Array) -> Array:
    if len(points) <= MAX_VERTICES:
        return points
    extreme = np.argmax((points - points.mean(axis=0)) @ _directions(MAX_VERTICES).T, axis=0)
    return points[np.unique(extreme)]


def _directions(count: int) -> Array:
    """(count, 3) unit vectors spread evenly, on a golden spiral."""
    index = np.arange(count)
    z = 1.0 - (2.0 * index + 1.0) / count
    turn = index * np.pi * (3.0 - np.sqrt(5.0))
    radius = np.sqrt(1.0 - z * z)
    return np.stack([radius * np.cos(turn), radius * np.sin(turn), z], axis=1)


def _centroid(points: Array, hull: ConvexHull) -> Array:
    """Centroid of the volume, by the tetrahedra from a point inside to each face."""
    inside = points[hull.vertices].mean(axis=0)
    corners = points[hull.simplices]
    volumes = np.abs(np.linalg.det(corners - inside))
    return np.einsum("f,fx->x", volumes, corners.sum(axis=1) + inside) / (4.0 * volumes.sum())
