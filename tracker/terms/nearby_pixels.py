"""The pixels around a pixel, nearest first, and that of a vertex."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import numpy.typing as npt
from numba import njit


@lru_cache(maxsize=16)
def find_nearby_pixels(radius: int) -> npt.NDArray[np.int32]:
    """(N, 2) steps in rows and columns to all pixels at most `radius` px away, the nearest first, (0, 0) before all."""
    assert radius >= 0
    steps = np.indices((2 * radius + 1, 2 * radius + 1)).reshape(2, -1).T - radius
    squared = (steps**2).sum(axis=1)
    steps = steps[squared <= radius * radius]
    order = np.argsort((steps**2).sum(axis=1), kind="stable")
    nearby = np.ascontiguousarray(steps[order], dtype=np.int32)
    nearby.setflags(write=False)
    return nearby


@njit(cache=True, nogil=True)
def find_ring_pixel(row, column, ring, side, edge):
    """Row and column of a pixel `ring` px around another: edges 0 to 3, sides 0 to 2 ring."""
    if edge == 0:
        return row - ring, column - ring + side
    if edge == 1:
        return row + ring, column - ring + side
    if edge == 2:
        return row - ring + side, column - ring
    return row - ring + side, column + ring


@njit(cache=True, nogil=True)
def find_vertex_pixel(projected, v, height, width):
    """Row and column of the pixel that a vertex projects into; -1 where it is not in sight.

    Args:
        projected: (V, 3) column px, row px, inverse depth 1/m, 0 where a vertex is not in front.
        v: The vertex.
        height: Of the image, px.
        width: px.
    """
    if projected[v, 2] > 0.0:
        column, row = int(np.rint(projected[v, 0])), int(np.rint(projected[v, 1]))
        if 0 <= row < height and 0 <= column < width:
            return row, column
    return -1, -1
