"""Errors of followed joints, and how sure their means are."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

BLOCK = 8
"""Frames that are drawn together: errors of neighbours are alike."""

RESAMPLES, SEED = 2000, 20160508

BONES = [(0 if joint % 4 == 1 else joint - 1, joint) for joint in range(1, 21)]
"""From one of the 21 joints to the next one outwards."""


@dataclass(frozen=True)
class Errors:
    """Of one run or several together.

    Attributes:
        mm: (T, J) distance of each joint from the truth.
        degrees: (T, B) angle between each bone and the true one.
    """

    mm: Array
    degrees: Array

    @classmethod
    def of(cls, joints: Array, truth: Array) -> Errors:
        """Joints and truth (T, 21 hands, 3), world, m."""
        mm = 1000.0 * np.linalg.norm(joints - truth, axis=2)
        found, true = (_directions(points) for points in (joints, truth))
        cosines = np.clip(np.einsum("tbi,tbi->tb", found, true), -1.0, 1.0)
        return cls(mm, np.degrees(np.arccos(cosines)))

    @classmethod
    def join(cls, parts: list[Errors]) -> Errors:
        """Of several recordings, one after the other."""
        return cls(np.concatenate([part.mm for part in parts]), np.concatenate([part.degrees for part in parts]))


def find_interval(frames: Array) -> tuple[float, float]:
    """95 % interval of the mean of frames (T,), by a bootstrap over blocks of `BLOCK` of them."""
    blocks = [frames[start : start + BLOCK] for start in range(0, len(frames), BLOCK)]
    sums, counts = np.array([block.sum() for block in blocks]), np.array([len(block) for block in blocks])
    drawn = np.random.default_rng(SEED).integers(len(blocks), size=(RESAMPLES, len(blocks)))
    means = sums[drawn].sum(axis=1) / counts[drawn].sum(axis=1)
    low, high = np.percentile(means, [2.5, 97.5])
    return float(low), float(high)


def _directions(joints: Array) -> Array:
    """(T, 20 hands, 3) unit, of every bone."""
    parts = []
    for hand in range(joints.shape[1] // 21):
        own = joints[:, 21 * hand : 21 * hand + 21]
        parts.append(own[:, [b for _, b in BONES]] - own[:, [a for a, _ in BONES]])
    bones = np.concatenate(parts, axis=1)
    return bones / np.linalg.norm(bones, axis=2, keepdims=True)
