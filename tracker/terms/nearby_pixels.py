"""The pixels around a pixel, nearest first."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import numpy.typing as npt


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
