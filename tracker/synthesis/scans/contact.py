"""Skin that presses against skin gives way: neither surface ends up inside the other."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import numpy.typing as npt
from numba import njit
from scipy.sparse import csr_matrix, diags

from tracker.synthesis.scans.subject import load_surface
from tracker.synthesis.scans.tissue import vertex_normals

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

REACH = 4.5e-3
"""Skin that is nearer to other skin may be inside it, m."""

APART = 14e-3
"""Skin that is nearer to it at rest is the same skin, folded, m."""

ASIDE = 2.0e-3
"""Skin is in front of a vertex that is at most so far beside its normal, m."""

ROUNDS = 6
"""At most."""
SMOOTHING = 3
"""Rounds that spread a push over the skin around it."""


def give_way(vertices: Array, rest: Array) -> Array:
    """Posed vertices (V, 3) of the deformed mesh, where parts of it that had passed through each other only touch.

    Each vertex that is behind the skin it meets goes back by half of that along its own normal, and its neighbours
    go with it: what was a pass-through becomes a flat.

    Args:
        vertices: (V, 3) posed, m.
        rest: (V, 3) the same at rest, m.
    """
    surface = load_surface()
    moved = vertices
    for _ in range(ROUNDS):
        normals = vertex_normals(moved, surface.faces)
        depth = find_depths(moved, normals, rest)
        if not depth.any():
            break
        push = -0.6 * depth[:, None] * normals
        own = np.where(depth > 0.0, 0.5, 0.0)[:, None]
        for _ in range(SMOOTHING):
            push = own * push + (1.0 - own) * (_mean() @ push)
        moved = moved + push
    return moved


def find_depths(vertices: Array, normals: Array, rest: Array) -> Array:
    """(V,) how far each vertex is behind skin that was elsewhere at rest and faces it, m; 0 where it is not."""
    low = vertices.min(axis=0)
    cells = ((vertices - low) / REACH).astype(np.int64) + 1
    size = cells.max(axis=0) + 2
    keys = (cells[:, 0] * size[1] + cells[:, 1]) * size[2] + cells[:, 2]
    order = np.argsort(keys, kind="stable")
    starts = np.searchsorted(keys[order], np.arange(int(size.prod()) + 1))
    depth = _depths(vertices, normals, rest, cells, size, order, starts, REACH, APART)
    # One vertex alone behind other skin is a corner of the mesh seen askew.
    return np.where(_mean() @ depth > 0.0, depth, 0.0)


@njit(cache=True, nogil=True)
def _depths(
    vertices: Array,
    normals: Array,
    rest: Array,
    cells: Ints,
    size: Ints,
    order: Ints,
    starts: Ints,
    reach: float,
    apart: float,
) -> Array:
    depth = np.zeros(len(vertices))
    for i in range(len(vertices)):
        nearest = ASIDE
        for x in range(cells[i, 0] - 1, cells[i, 0] + 2):
            for y in range(cells[i, 1] - 1, cells[i, 1] + 2):
                first = (x * size[1] + y) * size[2] + cells[i, 2] - 1
                for place in range(starts[first], starts[first + 3]):
                    j = order[place]
                    dx = vertices[i, 0] - vertices[j, 0]
                    dy = vertices[i, 1] - vertices[j, 1]
                    dz = vertices[i, 2] - vertices[j, 2]
                    square = dx * dx + dy * dy + dz * dz
                    if square > reach * reach:
                        continue
                    cosine = (
                        normals[i, 0] * normals[j, 0] + normals[i, 1] * normals[j, 1] + normals[i, 2] * normals[j, 2]
                    )
                    if cosine > -0.3:
                        continue
                    u, v, w = rest[i, 0] - rest[j, 0], rest[i, 1] - rest[j, 1], rest[i, 2] - rest[j, 2]
                    if u * u + v * v + w * w < apart * apart:
                        continue
                    # The skin that a vertex meets is what lies nearest beside the other's normal.
                    height = dx * normals[j, 0] + dy * normals[j, 1] + dz * normals[j, 2]
                    aside = np.sqrt(max(square - height * height, 0.0))
                    if aside < nearest:
                        nearest = aside
                        depth[i] = max(-height, 0.0)
    return depth


@lru_cache(maxsize=1)
def _mean() -> csr_matrix:
    """(V, V) the mean of a vertex's neighbours."""
    faces = load_surface().faces
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    both = np.unique(np.concatenate([edges, edges[:, ::-1]]), axis=0)
    size = int(faces.max()) + 1
    graph = csr_matrix((np.ones(len(both)), (both[:, 0], both[:, 1])), shape=(size, size))
    return csr_matrix(diags(1.0 / np.asarray(graph.sum(axis=1)).ravel()) @ graph)
