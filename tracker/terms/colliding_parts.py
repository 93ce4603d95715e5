"""Which triangles of a scene could collide, and which do."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components, dijkstra

from tracker.geometry.crossings import find_crossings_into
from tracker.geometry.triangle_tree import Filter, FittedTree, TriangleTree, build_triangle_tree, fit_tree
from tracker.model.scene import PosedScene, Scene

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int32]
Bools = npt.NDArray[np.bool_]

SAME_SKIN = 0.010
"""A triangle does not collide with a part that is so near along the skin, m: there it only folds."""

USUAL_PAIRS = 4096
"""Room for this many crossing pairs at first; a fist has some hundreds."""


class CollidingParts(NamedTuple):
    """What stays the same at all poses. A part is the skin that follows one bone most; groups are the scene's bones.

    tree; allowed; vertex_groups (V,) part of a vertex, -1 where no face uses it; vertices_may_meet (V, G);
    neighbour_starts (V + 1,) and neighbours (E,) vertices that share an edge; model_starts (M + 1,) range of groups of
    each model; seeds (S,) one vertex of each piece of surface.
    """

    tree: TriangleTree
    allowed: Filter
    vertex_groups: Ints
    vertices_may_meet: Bools
    neighbour_starts: Ints
    neighbours: Ints
    model_starts: Ints
    seeds: Ints


@dataclass(frozen=True)
class Crossings:
    """Triangles of a posed scene that cross though they may not.

    Attributes:
        parts: The scene's parts.
        fitted: The parts' tree at this pose.
        pairs: (C, 2) triangles, each pair once, the set 𝒞 of [T16] §3.2.4.
    """

    parts: CollidingParts
    fitted: FittedTree
    pairs: Ints


def find_crossings(posed: PosedScene) -> Crossings:
    """Crossing triangles of different models, or of parts of one model that are not neighbours.

    Left out are pairs that share a vertex, pairs of parts whose bones are the same or parent and child, triangles next
    to each other along the skin (SAME_SKIN), and pairs of parts of one model that cross at rest already.
    """
    return _find_crossings(find_parts(posed.scene), posed.vertices, posed.scene.arrays.faces)


def _find_crossings(parts: CollidingParts, vertices: Array, faces: Ints) -> Crossings:
    fitted = fit_tree(parts.tree, parts.allowed, vertices, faces)
    pairs = np.empty((USUAL_PAIRS, 2), dtype=np.int32)
    count = find_crossings_into(pairs, fitted)
    if count > len(pairs):
        pairs = np.empty((count, 2), dtype=np.int32)
        find_crossings_into(pairs, fitted)
    return Crossings(parts, fitted, pairs[:count])


def find_parts(scene: Scene) -> CollidingParts:
    """The scene's parts; worked out once for a scene."""
    cached = scene.__dict__.get("_colliding_parts")
    if cached is None:
        cached = scene.__dict__["_colliding_parts"] = _find_parts(scene)
    return cached


def _find_parts(scene: Scene) -> CollidingParts:
    arrays = scene.arrays
    faces, num_vertices, bones = arrays.faces, len(arrays.vertices), len(arrays.parents)
    follows = np.zeros((num_vertices, bones))
    for slot in range(arrays.weights.shape[1]):
        np.add.at(follows, (np.arange(num_vertices), arrays.weight_bones[:, slot]), arrays.weights[:, slot])
    face_groups = follows[faces].sum(axis=1).argmax(axis=1).astype(np.int32)
    corners, corner_groups = faces.ravel(), np.repeat(face_groups, 3)
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    edges = np.unique(np.concatenate([edges, edges[:, ::-1]]), axis=0)
    lengths = np.linalg.norm(arrays.vertices[edges[:, 0]] - arrays.vertices[edges[:, 1]], axis=1)
    shape = (num_vertices, num_vertices)

    groups_may_meet = ~_neighbours(arrays.parents, np.unique(face_groups))
    skin = coo_array((np.maximum(lengths, 1e-9), (edges[:, 0], edges[:, 1])), shape=shape).tocsr()
    triangles_may_meet = groups_may_meet[face_groups]
    for group in np.unique(face_groups):
        own = np.unique(faces[face_groups == group])
        distances = dijkstra(skin, indices=own, min_only=True, limit=SAME_SKIN)
        triangles_may_meet[np.isfinite(distances[faces]).any(axis=1), group] = False

    ordered = edges[np.lexsort((edges[:, 1], edges[:, 0]))]
    _, pieces = connected_components(skin, directed=False)
    used = np.unique(faces)
    vertex_groups = np.full(num_vertices, -1, dtype=np.int32)
    vertex_groups[corners] = corner_groups
    parts = CollidingParts(
        tree=build_triangle_tree(arrays.vertices[faces].mean(axis=1), face_groups, bones),
        allowed=Filter(groups_may_meet, triangles_may_meet),
        vertex_groups=vertex_groups,
        vertices_may_meet=np.zeros((num_vertices, bones), dtype=np.bool_),
        neighbour_starts=np.searchsorted(ordered[:, 0], np.arange(num_vertices + 1)).astype(np.int32),
        neighbours=np.ascontiguousarray(ordered[:, 1], dtype=np.int32),
        model_starts=np.array([s.start for s in scene.bone_slices] + [bones], dtype=np.int32),
        seeds=used[np.unique(pieces[used], return_index=True)[1]].astype(np.int32),
    )
    _part_those_that_touch_at_rest(parts, scene)
    may_not = np.zeros((num_vertices, bones), dtype=np.int64)
    np.add.at(may_not, corners, np.repeat(~parts.allowed.triangles, 3, axis=0).astype(np.int64))
    parts.vertices_may_meet[:] = may_not == 0
    return parts


def _neighbours(parents: Ints, with_skin: npt.NDArray[np.int32]) -> Bools:
    """(G, G) whether bones are the same, or parent and child when bones without skin are left out."""
    result = np.eye(len(parents), dtype=np.bool_)
    has_skin = np.isin(np.arange(len(parents)), with_skin)
    for bone in range(len(parents)):
        parent = parents[bone]
        while parent >= 0 and not has_skin[parent]:
            parent = parents[parent]
        if parent >= 0:
            result[bone, parent] = result[parent, bone] = True
    return result


def _part_those_that_touch_at_rest(parts: CollidingParts, scene: Scene) -> None:
    """Forbid pairs of groups of one model that cross at rest, where models stand in each other."""
    groups, models = parts.tree.groups, np.repeat(np.arange(len(scene.models)), np.diff(parts.model_starts))
    between = models[:, None] != models[None]
    within = parts._replace(
        allowed=Filter(
            np.ascontiguousarray(parts.allowed.groups & ~between),
            np.ascontiguousarray(parts.allowed.triangles & ~between[groups]),
        )
    )
    crossings = _find_crossings(within, scene.arrays.vertices, scene.arrays.faces)
    first, second = groups[crossings.pairs[:, 0]], groups[crossings.pairs[:, 1]]
    parts.allowed.groups[first, second] = parts.allowed.groups[second, first] = False
    parts.allowed.triangles[:] &= parts.allowed.groups[groups]
