"""The few votes that stand for all offsets of a leaf."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

ROUNDS = 10
"""Of k-means."""


def find_modes(offsets: npt.NDArray[np.float32], count: int) -> npt.NDArray[np.float32]:
    """Groups of offsets (N, 3), the largest first: (count, 4) their means and their share; zeros for none left.

    Grouped by column and row, px of a patch; the depth goes along. k-means from starts that are far from each other,
    the first of them at the mean. Always the same for the same offsets.
    """
    modes = np.zeros((count, 4), dtype=np.float32)
    if len(offsets) == 0:
        return modes
    points = offsets[:, :2].astype(np.float64)
    centers = points.mean(axis=0)[None]
    while len(centers) < min(count, len(points)):
        distances = ((points[:, None] - centers[None]) ** 2).sum(axis=2).min(axis=1)
        if distances.max() < 1.0:  # px², of a patch: not worth a vote of its own
            break
        centers = np.concatenate([centers, points[np.argmax(distances)][None]])
    for _ in range(ROUNDS):
        group = ((points[:, None] - centers[None]) ** 2).sum(axis=2).argmin(axis=1)
        present = np.unique(group)
        centers = np.stack([points[group == g].mean(axis=0) for g in present])
    group = ((points[:, None] - centers[None]) ** 2).sum(axis=2).argmin(axis=1)
    shares = np.bincount(group, minlength=len(centers)) / len(points)
    order = [int(g) for g in np.argsort(-shares, kind="stable") if shares[g] > 0.0]
    for place, g in enumerate(order):
        modes[place, :3] = offsets[group == g].mean(axis=0, dtype=np.float64)
        modes[place, 3] = shares[g]
    return modes
