"""Points and normals of a depth image."""

from __future__ import annotations

import numpy as np
from numba import njit

MAX_STEP = 0.012
"""Neighbours whose depth differs by more than this do not lie on one surface, m."""


@njit(cache=True, nogil=True)
def compute_points_and_normals_into(points, normals, depth, K, T):
    """Back-project a depth image and estimate normals from central differences over two pixels, one-sided at borders.

    Args:
        points: (H, W, 3) float32 out, world, m.
        normals: (H, W, 3) float32 out, world, unit, towards the camera; 0 where neighbours are missing.
        depth: (H, W) float32, m; 0 for none.
        K: (3, 3) px.
        T: (4, 4) T_world_camera.
    """
    height, width = depth.shape
    fx, fy, cx, cy = K[0, 0], K[1, 1], K[0, 2], K[1, 2]
    for row in range(height):
        for column in range(width):
            z = depth[row, column]
            if z <= 0.0:
                continue
            x, y = (column - cx) / fx * z, (row - cy) / fy * z
            for i in range(3):
                points[row, column, i] = T[i, 0] * x + T[i, 1] * y + T[i, 2] * z + T[i, 3]
            left, right = _reach(depth, row, column, 0, -1), _reach(depth, row, column, 0, 1)
            up, down = _reach(depth, row, column, -1, 0), _reach(depth, row, column, 1, 0)
            if left + right == 0 or up + down == 0:
                continue
            za, zb = depth[row, column - left], depth[row, column + right]
            ux = (column + right - cx) / fx * zb - (column - left - cx) / fx * za
            uy = (row - cy) / fy * (zb - za)
            uz = zb - za
            za, zb = depth[row - up, column], depth[row + down, column]
            vx = (column - cx) / fx * (zb - za)
            vy = (row + down - cy) / fy * zb - (row - up - cy) / fy * za
            vz = zb - za
            # down x right points towards the camera
            nx, ny, nz = vy * uz - vz * uy, vz * ux - vx * uz, vx * uy - vy * ux
            length = np.sqrt(nx * nx + ny * ny + nz * nz)
            if length <= 0.0:
                continue
            for i in range(3):
                normals[row, column, i] = (T[i, 0] * nx + T[i, 1] * ny + T[i, 2] * nz) / length


@njit(cache=True, nogil=True)
def _reach(depth, row, column, step_row, step_column):
    """Pixels, at most two, that one can go in a direction without leaving the surface."""
    height, width = depth.shape
    reached = 0
    z = depth[row, column]
    for k in range(1, 3):
        r, c = row + k * step_row, column + k * step_column
        if r < 0 or c < 0 or r >= height or c >= width:
            break
        if depth[r, c] <= 0.0 or abs(depth[r, c] - z) > MAX_STEP * k:
            break
        reached = k
    return reached
