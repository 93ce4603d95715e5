"""Small parts of a hand that show by themselves: fingertips beyond a thing that hides the rest of their fingers."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

SMALLEST, LARGEST = 1.5e-5, 4e-4
"""Area, m², of what may be a fingertip: a tip that shows by half, and a finger's outer two bones."""


@dataclass(frozen=True)
class Island:
    """Hand pixels with none of the hand around them.

    Attributes:
        is_in: (H, W) its pixels.
        middle: (2,) column and row, px.
        depth: Of most of them, m.
        area: Across the viewing rays, m².
    """

    is_in: npt.NDArray[np.bool_]
    middle: npt.NDArray[np.float64]
    depth: float
    area: float


def find_islands(
    is_hand: npt.NDArray[np.bool_], depth: npt.NDArray[np.float32], K: npt.NDArray[np.float64]
) -> list[Island]:
    """Those as large as a fingertip, the largest first.

    Args:
        is_hand: (H, W) pixels that may be hand.
        depth: (H, W) m.
        K: (3, 3) px.
    """
    count, parts = cv2.connectedComponents(is_hand.astype(np.uint8), connectivity=8)
    areas = np.bincount(parts.ravel(), depth.ravel() ** 2, count) / (K[0, 0] * K[1, 1])
    islands = []
    for part in 1 + np.flatnonzero((areas[1:] > SMALLEST) & (areas[1:] < LARGEST)):
        is_in = parts == part
        rows, columns = np.nonzero(is_in)
        middle = np.array([np.median(columns), np.median(rows)])
        islands.append(Island(is_in, middle, float(np.median(depth[is_in])), float(areas[part])))
    return sorted(islands, key=lambda island: -island.area)
