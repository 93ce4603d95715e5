"""Making a clean triangle mesh of whatever an object's file holds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import breadth_first_order, connected_components
from scipy.spatial import KDTree

from tracker.geometry.triangles import is_watertight

Array = npt.NDArray[np.float64]
Faces = npt.NDArray[np.int64]

MERGE_SHARE = 1e-6
"""Vertices nearer than this share of the mesh's size are one."""


@dataclass(frozen=True)
class CleanMesh:
    """A mesh whose faces look outwards.

    Attributes:
        vertices: (V, 3), every one used.
        faces: (F, 3).
        open_edges: Edges with a face on one side only, or more than two: 0 for a closed mesh.
    """

    vertices: Array
    faces: Faces
    open_edges: int


def clean_mesh(vertices: Array, faces: Faces) -> CleanMesh:
    """Merge split vertices, drop faces without area and doubles, turn the faces outwards piece by piece.

    A piece with holes is turned so that most of it looks away from its middle.
    """
    size = float(np.ptp(vertices, axis=0).max()) if len(vertices) else 0.0
    first, inverse = _merge(vertices, MERGE_SHARE * size)
    merged = inverse[faces]
    vertices = vertices[first]
    merged = merged[_has_area(vertices, merged)]
    _, kept = np.unique(np.sort(merged, axis=1), axis=0, return_index=True)
    merged = merged[np.sort(kept)]
    used, merged = np.unique(merged, return_inverse=True)
    faces = merged.reshape(-1, 3).astype(np.int64)
    vertices = vertices[used]
    return CleanMesh(vertices, _turn_outwards(vertices, faces), _count_open_edges(faces))


def _merge(vertices: Array, distance: float) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """Ids (M,) of vertices that stand for all, and which of them each vertex (V,) is.

    Most that are one are so to the last digits, and share a cell of a grid; the others lie on both sides of its lines.
    """
    cells = np.round((vertices - vertices.min(axis=0)) / max(distance, 1e-300))
    _, first, inverse = np.unique(cells, axis=0, return_index=True, return_inverse=True)
    pairs = KDTree(vertices[first]).query_pairs(distance, output_type="ndarray")
    graph = coo_matrix((np.ones(len(pairs), dtype=np.int8), (pairs[:, 0], pairs[:, 1])), shape=(len(first), len(first)))
    groups = connected_components(graph, directed=False)[1]
    _, kept, places = np.unique(groups, return_index=True, return_inverse=True)
    order = np.argsort(kept, kind="stable")
    rank = np.argsort(order, kind="stable")
    return first[kept[order]], rank[places.ravel()][inverse.ravel()]


def _has_area(vertices: Array, faces: Faces) -> npt.NDArray[np.bool_]:
    a, b, c = (vertices[faces[:, corner]] for corner in range(3))
    double = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    longest = np.maximum(np.linalg.norm(b - a, axis=1), np.linalg.norm(c - a, axis=1))
    return double > 1e-9 * longest**2


def _edges(faces: Faces) -> Faces:
    """(3F, 2) directed, those of the first side of every face before those of the second."""
    return np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])


def _count_open_edges(faces: Faces) -> int:
    _, counts = np.unique(np.sort(_edges(faces), axis=1), axis=0, return_counts=True)
    return int(np.sum(counts != 2))


def _turn_outwards(vertices: Array, faces: Faces) -> Faces:
    if not len(faces):
        return faces
    if not is_watertight(faces):
        faces = np.where(_find_disagreeing(faces)[:, None], faces[:, ::-1], faces)
    pieces = connected_components(_neighbours(faces)[0], directed=False)[1]
    corners = vertices[faces]
    middles = np.stack([np.bincount(pieces, corners[:, :, axis].sum(axis=1)) for axis in range(3)], axis=1)
    middles /= 3.0 * np.bincount(pieces)[:, None]
    volumes = np.bincount(pieces, np.linalg.det(corners - middles[pieces, None]))
    return np.where((volumes < 0.0)[pieces][:, None], faces[:, ::-1], faces)


def _neighbours(faces: Faces) -> tuple[coo_matrix, coo_matrix]:
    """(F, F) which faces share an edge that has just two faces, and which of them run through it the same way."""
    directed = _edges(faces)
    owners = np.tile(np.arange(len(faces)), 3)
    forward = directed[:, 0] < directed[:, 1]
    _, edge, counts = np.unique(np.sort(directed, axis=1), axis=0, return_inverse=True, return_counts=True)
    order = np.argsort(edge.ravel(), kind="stable")
    starts = np.cumsum(np.r_[0, counts])[:-1][counts == 2]
    one, two = order[starts], order[starts + 1]
    is_same = forward[one] == forward[two]
    shape = (len(faces), len(faces))
    ones = np.ones(len(one), dtype=np.int8)
    linked = coo_matrix((ones, (owners[one], owners[two])), shape=shape)
    against = coo_matrix((ones[is_same], (owners[one][is_same], owners[two][is_same])), shape=shape)
    return linked, against


def _find_disagreeing(faces: Faces) -> npt.NDArray[np.bool_]:
    """(F,) which faces to turn so that neighbours run through their common edge in opposite directions.

    A walk over the faces from a node that is joined to the first face of every piece.
    """
    linked, against = _neighbours(faces)
    count = len(faces)
    firsts = np.unique(connected_components(linked, directed=False)[1], return_index=True)[1]
    rows, columns = np.r_[linked.row, np.full(len(firsts), count)], np.r_[linked.col, firsts]
    graph = coo_matrix((np.ones(len(rows), dtype=np.int8), (rows, columns)), shape=(count + 1, count + 1))
    order, parents = breadth_first_order(graph.tocsr(), count, directed=False)
    conflicts = {frozenset(pair) for pair in zip(against.row.tolist(), against.col.tolist(), strict=True)}
    flipped = [False] * (count + 1)
    for face in order[1:].tolist():
        parent = int(parents[face])
        flipped[face] = flipped[parent] ^ (frozenset((face, parent)) in conflicts)
    return np.array(flipped[:count])
