"""Z-buffer rendering of triangle meshes, perspective-correct, pixel centres at integers."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from numba import njit

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int32]


@dataclass(frozen=True)
class Rendering:
    """What a pinhole camera sees of a mesh.

    Attributes:
        depth: (H, W) along the optical axis, m; 0 where nothing is.
        face: (H, W) index of the nearest face; -1 where nothing is.
    """

    depth: Array
    face: Ints


def render_depth(vertices_camera: Array, faces: Ints, K: Array, width: int, height: int) -> Rendering:
    """Render vertices (V, 3) camera, m, and faces (F, 3) through K (3, 3) px, without distortion."""
    assert vertices_camera.ndim == 2 and vertices_camera.shape[1] == 3
    inverse_depth = np.zeros((height, width))
    face = np.full((height, width), -1, dtype=np.int32)
    projected = np.zeros((len(vertices_camera), 3))
    project_into(projected, np.ascontiguousarray(vertices_camera, dtype=np.float64), K[0, 0], K[1, 1], K[0, 2], K[1, 2])
    both_sides = np.ones(len(faces), dtype=np.bool_)
    rasterize_into(inverse_depth, face, projected, np.ascontiguousarray(faces, dtype=np.int32), both_sides)
    depth = np.where(face >= 0, 1.0 / np.maximum(inverse_depth, 1e-9), 0.0)
    return Rendering(depth, face)


NEAR = 0.02
"""Faces with a vertex nearer than this are not drawn, m."""


@njit(cache=True, nogil=True)
def project_into(projected: Array, vertices: Array, fx: float, fy: float, cx: float, cy: float) -> None:
    """Write (V, 3): column px, row px and inverse depth 1/m of vertices (V, 3) camera; inverse depth 0 if too near."""
    for v in range(len(vertices)):
        z = vertices[v, 2]
        if z < NEAR:
            projected[v, 0] = projected[v, 1] = projected[v, 2] = 0.0
        else:
            projected[v, 0] = fx * vertices[v, 0] / z + cx
            projected[v, 1] = fy * vertices[v, 1] / z + cy
            projected[v, 2] = 1.0 / z


@njit(cache=True, nogil=True)
def rasterize_into(
    inverse_depth: Array, face: Ints, projected: Array, faces: Ints, both_sides: npt.NDArray[np.bool_]
) -> None:
    """Draw faces over the buffers; the nearest wins. Buffers (H, W): inverse depth 1/m (0 = empty) and face index.

    The order of faces decides between equal depths, so the result is the same on every run. Faces seen from behind are
    drawn where both_sides (F,) says so: a closed mesh hides them anyway, an open one should not have holes.
    """
    height, width = inverse_depth.shape
    for f in range(len(faces)):
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        za, zb, zc = projected[a, 2], projected[b, 2], projected[c, 2]
        if za == 0.0 or zb == 0.0 or zc == 0.0:
            continue
        xa, ya, xb, yb, xc, yc = (
            projected[a, 0],
            projected[a, 1],
            projected[b, 0],
            projected[b, 1],
            projected[c, 0],
            projected[c, 1],
        )
        area = (xb - xa) * (yc - ya) - (yb - ya) * (xc - xa)
        if area == 0.0 or (area > 0.0 and not both_sides[f]):
            continue  # rows count downwards, so a face seen from outside has a negative area
        top, bottom = min(ya, yb, yc), max(ya, yb, yc)
        left, right = min(xa, xb, xc), max(xa, xb, xc)
        if right < 0.0 or bottom < 0.0 or left > width - 1 or top > height - 1:
            continue
        row_first, row_last = max(0, int(np.ceil(top))), min(height - 1, int(np.floor(bottom)))
        column_first, column_last = max(0, int(np.ceil(left))), min(width - 1, int(np.floor(right)))
        scale = 1.0 / area
        # Barycentric weights of b and c are linear in the pixel; their steps:
        step_b_x, step_b_y = (yc - ya) * scale, -(xc - xa) * scale
        step_c_x, step_c_y = -(yb - ya) * scale, (xb - xa) * scale
        slope_b, slope_c = zb - za, zc - za
        for row in range(row_first, row_last + 1):
            wb = (column_first - xa) * step_b_x + (row - ya) * step_b_y
            wc = (column_first - xa) * step_c_x + (row - ya) * step_c_y
            for column in range(column_first, column_last + 1):
                if wb >= 0.0 and wc >= 0.0 and wb + wc <= 1.0:
                    inverse = za + wb * slope_b + wc * slope_c
                    if inverse > inverse_depth[row, column]:
                        inverse_depth[row, column] = inverse
                        face[row, column] = f
                wb += step_b_x
                wc += step_c_x
