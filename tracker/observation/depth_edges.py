"""Depth discontinuities of an observed hand, [T16] §3.2.3.

Differs from the paper: a discontinuity is a pixel of the nearer side of a depth step instead of a Canny edge, so that
it lies on the hand and has the hand's depth. Steps towards something nearer are left out: they are the other's contour.
"""

from __future__ import annotations

from numba import njit


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
