"""Depth discontinuities of an observed hand, [T16] §3.2.3.

Differs from the paper: a discontinuity is a pixel of the nearer side of a depth step instead of a Canny edge, so that
it lies on the hand and has the hand's depth. Steps towards something nearer are left out: they are the other's contour.
"""

from __future__ import annotations

import numpy as np
from numba import njit

FALL_RADIUS = 2
"""px around a discontinuity that tell to which side of it the surface ends."""


@njit(cache=True, nogil=True)
def find_depth_edges_into(edges, depth, mask, jump):
    """Mark hand pixels next to nothing or to something deeper by more than `jump`.

    Args:
        edges: (H, W) uint8 out, 1 at a discontinuity; must come zeroed.
        depth: (H, W) float32, m; 0 for none.
        mask: (H, W) uint8, 1 on the hand.
        jump: m.
    """
    height, width = depth.shape
    for row in range(1, height - 1):
        for column in range(1, width - 1):
            if mask[row, column] == 0:
                continue
            limit = depth[row, column] + jump
            for dr, dc in ((0, 1), (0, -1), (1, 0), (-1, 0)):
                other = depth[row + dr, column + dc]
                if other == 0.0 or other > limit:
                    edges[row, column] = 1
                    break


@njit(cache=True, nogil=True)
def find_fall(values, is_inverse, row, column, jump):
    """To which side of a discontinuity the surface ends: the orientation of an edge, with its sign, [T16] §3.2.3.

    Args:
        values: (H, W) depth, m, or where `is_inverse` one over it; 0 for none.
        is_inverse: Which of the two.
        row, column: The pixel of the nearer side.
        jump: m.

    Returns:
        Unit step in columns and rows towards what is deeper or nothing; (0, 0) where it is all around or nowhere.
    """
    height, width = values.shape
    here = values[row, column]
    limit = 1.0 / (1.0 / here + jump) if is_inverse else here + jump
    x, y = 0.0, 0.0
    for dr in range(-FALL_RADIUS, FALL_RADIUS + 1):
        for dc in range(-FALL_RADIUS, FALL_RADIUS + 1):
            r, c = row + dr, column + dc
            if r < 0 or c < 0 or r >= height or c >= width:
                continue
            value = values[r, c]
            if value == 0.0 or (value < limit if is_inverse else value > limit):
                x += dc
                y += dr
    length = np.sqrt(x * x + y * y)
    if length == 0.0:
        return 0.0, 0.0
    return x / length, y / length
