"""The search for the binary test that separates the patches of a node best."""

from __future__ import annotations

import numpy as np
from numba import njit

from tracker.detection.channels import CHANNELS
from tracker.detection.levels import PATCH

THRESHOLDS = 10
"""Thresholds that are tried with each pair of pixels."""


@njit(cache=True, nogil=True)
def find_best_split(patches, members, pairs, cuts, by_offset, negative_weight, min_leaf, best):
    """Try every pair with every threshold on the members; write channel, first, second, threshold into best (4,).

    By class the information gain counts, fingertips and others weighted so that both sorts are equally many in the
    whole forest; by offset the squared distances of the fingertips' offsets from their mean on each side. Returns
    whether a test leaves at least `min_leaf` members, as a share of those tried, on both sides.

    Args:
        patches: channels, corners, widths, is_fingertip and offsets of `Patches`.
        members: (M,) patches of the node.
        pairs: (P, 3) channel, first, second: places in a patch.
        cuts: (P, THRESHOLDS) 0..1, where thresholds lie between the smallest and the largest difference.
        by_offset: Whether offsets or classes are to be separated.
        negative_weight: Of a patch that is no fingertip.
        min_leaf: Smallest number of members on each side.
        best: int16 (4,).
    """
    channels, corners, widths, is_fingertip, offsets = patches
    count = len(members)
    values = np.empty(count, dtype=np.int16)
    bins = np.empty(512, dtype=np.int16)
    sums = np.empty((THRESHOLDS + 1, 6))
    limits = np.empty(THRESHOLDS, dtype=np.int64)
    best_score = -np.inf
    for p in range(len(pairs)):
        channel, first, second = pairs[p, 0], pairs[p, 1], pairs[p, 2]
        row_a, column_a, row_b, column_b = first // PATCH, first % PATCH, second // PATCH, second % PATCH
        low, high = 1000, -1000
        for m in range(count):
            n = members[m]
            corner, width = corners[n], widths[n]
            a = np.int16(channels[corner + (row_a * width + column_a) * CHANNELS + channel])
            b = np.int16(channels[corner + (row_b * width + column_b) * CHANNELS + channel])
            value = a - b
            values[m] = value
            low, high = min(low, value), max(high, value)
        if low == high:
            continue
        for t in range(THRESHOLDS):
            limits[t] = low + int(cuts[p, t] * (high - low))
        limits.sort()
        place = 0
        for value in range(low, high + 1):  # bin k: above k thresholds
            while place < THRESHOLDS and value > limits[place]:
                place += 1
            bins[value + 256] = place
        sums[:] = 0.0
        for m in range(count):
            n = members[m]
            s = sums[bins[values[m] + 256]]
            s[0] += 1.0
            if is_fingertip[n]:
                x, y = offsets[n, 0], offsets[n, 1]
                s[1] += 1.0
                s[3] += x
                s[4] += y
                s[5] += x * x + y * y
            else:
                s[2] += negative_weight
        total = np.zeros(6)
        for t in range(THRESHOLDS + 1):
            total += sums[t]
        below = np.zeros(6)
        for t in range(THRESHOLDS):
            below += sums[t]
            above = total - below
            if below[0] < min_leaf or above[0] < min_leaf:
                continue
            if by_offset:
                score = -(_scatter(below) + _scatter(above))
            else:
                score = -(_entropy(below) + _entropy(above))
            if score > best_score:
                best_score = score
                best[0], best[1], best[2], best[3] = channel, first, second, limits[t]
    return best_score > -np.inf


@njit(cache=True, nogil=True)
def _scatter(s):
    return 0.0 if s[1] == 0.0 else s[5] - (s[3] * s[3] + s[4] * s[4]) / s[1]


@njit(cache=True, nogil=True)
def _entropy(s):
    positive, negative = s[1], s[2]
    total = positive + negative
    result = 0.0
    if positive > 0.0:
        result -= positive * np.log(positive / total)
    if negative > 0.0:
        result -= negative * np.log(negative / total)
    return result


@njit(cache=True, nogil=True)
def goes_right(channels, corners, widths, members, test, result):
    """Write (M,) whether each member passes the test (4,): channel, first, second, threshold."""
    row_a, column_a, row_b, column_b = test[1] // PATCH, test[1] % PATCH, test[2] // PATCH, test[2] % PATCH
    for m in range(len(members)):
        corner, width = corners[members[m]], widths[members[m]]
        a = np.int32(channels[corner + (row_a * width + column_a) * CHANNELS + test[0]])
        b = np.int32(channels[corner + (row_b * width + column_b) * CHANNELS + test[0]])
        result[m] = a - b > test[3]
