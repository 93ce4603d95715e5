"""The eleven channels of a patch, [T16] §3.2.5: 5x5 minimum and maximum, and nine gradient orientations."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from numba import njit

BINS = 9
"""Of the directions of gradients, as in histograms of oriented gradients."""
CHANNELS = 2 + BINS
CELL = 5
"""Window of minimum, maximum and sums of gradients, px, [T16] §3.2.5."""

STEEP = 60
"""Differences across a pixel beyond this many levels count as this many: all outlines are equally strong."""

GAIN = 0.4
"""Scales the sum of gradients over a cell so that a straight outline through it stays within a byte."""


def compute_channels(image: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint8]:
    """Channels (H, W, CHANNELS) of an image (H, W) of levels: minimum, maximum, then BINS orientations.

    Orientations are those of the gradient without its sign, in BINS equal parts of half a turn; a gradient is shared
    between the two nearest bins by its angle. Pixels outside the image repeat its border for minimum and maximum and
    have no gradient.
    """
    channels = np.empty((*image.shape, CHANNELS), dtype=np.uint8)
    _compute_into(channels, image)
    return channels


@njit(cache=True, nogil=True)
def _compute_into(channels, image):
    height, width = image.shape
    half = CELL // 2
    lowest = np.empty((height, width), dtype=np.uint8)
    highest = np.empty((height, width), dtype=np.uint8)
    for r in range(height):
        for c in range(width):
            low, high = image[r, c], image[r, c]
            for k in range(max(0, c - half), min(width, c + half + 1)):
                value = image[r, k]
                low, high = min(low, value), max(high, value)
            lowest[r, c], highest[r, c] = low, high
    for r in range(height):
        first, last = max(0, r - half), min(height, r + half + 1)
        for c in range(width):
            low, high = lowest[r, c], highest[r, c]
            for k in range(first, last):
                low, high = min(low, lowest[k, c]), max(high, highest[k, c])
            channels[r, c, 0], channels[r, c, 1] = low, high

    # Sums over rows of a cell, then over columns, each with a running sum.
    oriented = np.zeros((height, width, BINS), dtype=np.float32)
    for r in range(1, height - 1):
        for c in range(1, width - 1):
            gx = float(image[r, c + 1]) - float(image[r, c - 1])
            gy = float(image[r + 1, c]) - float(image[r - 1, c])
            if gx == 0.0 and gy == 0.0:
                continue
            gx, gy = min(max(gx, -STEEP), STEEP), min(max(gy, -STEEP), STEEP)
            place = np.arctan2(gy, gx) * (BINS / np.pi)
            if place < 0.0:
                place += BINS
            lower = int(place)
            share = place - lower
            magnitude = np.sqrt(gx * gx + gy * gy)
            oriented[r, c, lower % BINS] += np.float32(magnitude * (1.0 - share))
            oriented[r, c, (lower + 1) % BINS] += np.float32(magnitude * share)
    across = np.zeros((height, width, BINS), dtype=np.float32)
    for r in range(height):
        for c in range(width):
            for k in range(max(0, c - half), min(width, c + half + 1)):
                for b in range(BINS):
                    across[r, c, b] += oriented[r, k, b]
    total = np.empty(BINS, dtype=np.float32)
    for r in range(height):
        first, last = max(0, r - half), min(height, r + half + 1)
        for c in range(width):
            total[:] = 0.0
            for k in range(first, last):
                for b in range(BINS):
                    total[b] += across[k, c, b]
            for b in range(BINS):
                channels[r, c, 2 + b] = min(255, int(total[b] * GAIN))
