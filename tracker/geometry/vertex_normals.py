"""Normals of a mesh at its vertices."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from numba import njit

Array = npt.NDArray[np.float64]


def find_unit_normals(vertices: Array, faces: npt.NDArray) -> Array:
    """(V, 3) unit normals, those of the triangles weighted by their area."""
    normals = np.empty_like(vertices)
    normals_into(normals, vertices, faces)
    return normals


@njit(cache=True, nogil=True)
def normals_into(normals: Array, vertices: Array, faces: npt.NDArray) -> None:
    """Write unit vertex normals (V, 3), area-weighted, outward for counter-clockwise faces; 0 where no face is."""
    normals[:, :] = 0.0
    for f in range(len(faces)):
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        ux, uy, uz = vertices[b, 0] - vertices[a, 0], vertices[b, 1] - vertices[a, 1], vertices[b, 2] - vertices[a, 2]
        wx, wy, wz = vertices[c, 0] - vertices[a, 0], vertices[c, 1] - vertices[a, 1], vertices[c, 2] - vertices[a, 2]
        nx, ny, nz = uy * wz - uz * wy, uz * wx - ux * wz, ux * wy - uy * wx
        for vertex in (a, b, c):
            normals[vertex, 0] += nx
            normals[vertex, 1] += ny
            normals[vertex, 2] += nz
    for v in range(len(normals)):
        length = np.sqrt(normals[v, 0] ** 2 + normals[v, 1] ** 2 + normals[v, 2] ** 2)
        if length > 0.0:
            normals[v, 0] /= length
            normals[v, 1] /= length
            normals[v, 2] /= length
