"""Triangles that bulge as the skin does between their corners.

A hand of 782 vertices is so coarse that flat triangles lie 0.45 mm inside a skin that all vertices lie on. So the
surface of a mesh, wherever points are laid onto it or measured against it, is curved: over a point with weights b of
the corners, Σ 4 b_i b_j m_ij is added, m_ij being how far the middle of an edge lies from its chord when it leaves
either end at right angles to the normal there (as in the curved PN triangles of Vlachos et al. 2001, up to the second
order). [R17] has flat triangles.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from numba import njit

from tracker.geometry.vertex_normals import find_unit_normals

Array = npt.NDArray[np.float64]


def find_bulges(vertices: Array, faces: npt.NDArray) -> Array:
    """(F, 3, 3) m: of edges 0-1, 1-2, 2-0 of each face (F, 3), from the middle of the chord to the curve's."""
    bulges = np.empty((len(faces), 3, 3))
    _bulges_into(bulges, vertices, find_unit_normals(vertices, faces), faces)
    return bulges


def find_middles(vertices: Array, faces: npt.NDArray) -> Array:
    """(F, 3) m, the middles of the curved triangles."""
    return vertices[faces].mean(axis=1) + 4.0 / 9.0 * find_bulges(vertices, faces).sum(axis=1)


def refine(vertices: Array, faces: npt.NDArray, levels: int = 2) -> tuple[Array, npt.NDArray[np.int64]]:
    """The curved surface as flat triangles, each one of the mesh cut into four `levels` times.

    Args:
        vertices: (V, 3) m. They stay the first ones, where they are.
        faces: (F, 3).

    Returns:
        Vertices and faces (4^levels F, 3); which vertex is where depends on `faces` alone.
    """
    corners = np.asarray(faces, dtype=np.int64)
    for _ in range(levels):
        ends = np.stack([corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 2)
        edges, first, middle = np.unique(np.sort(ends, axis=1), axis=0, return_index=True, return_inverse=True)
        bulges = find_bulges(vertices, corners).reshape(-1, 3)
        middle = len(vertices) + middle.reshape(-1, 3)
        vertices = np.concatenate([vertices, vertices[edges].mean(axis=1) + bulges[first]])
        (a, b, c), (ab, bc, ca) = corners.T, middle.T
        corners = np.stack([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]).transpose(2, 0, 1).reshape(-1, 3)
    return vertices, corners


@njit(cache=True, nogil=True)
def _bulges_into(bulges, vertices, normals, faces):
    for f in range(len(faces)):
        for k in range(3):
            i, j = faces[f, k], faces[f, (k + 1) % 3]
            x, y, z = vertices[j, 0] - vertices[i, 0], vertices[j, 1] - vertices[i, 1], vertices[j, 2] - vertices[i, 2]
            first = (x * normals[i, 0] + y * normals[i, 1] + z * normals[i, 2]) / 8.0
            last = (x * normals[j, 0] + y * normals[j, 1] + z * normals[j, 2]) / 8.0
            for d in range(3):
                bulges[f, k, d] = last * normals[j, d] - first * normals[i, d]


@njit(cache=True, nogil=True, inline="always")
def find_height(bulges, f, weights, n, directions):
    """How far the curved face f lies above the flat one along directions[n], at weights[n] of its corners, m."""
    height = 0.0
    for k in range(3):
        share = 4.0 * weights[n, k] * weights[n, (k + 1) % 3]
        if share > 0.0:
            for d in range(3):
                height += share * bulges[f, k, d] * directions[n, d]
    return height
