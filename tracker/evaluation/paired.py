"""Two tracks over the same joints of the same frames: how far apart they are, and how sure that is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from tracker.evaluation.evaluation import Evaluation

Array = npt.NDArray[np.float64]

RESAMPLES = 2000
"""Of the bootstrap."""
CONFIDENCE = 0.95
"""Of the interval around a difference."""
SEED = 20160508
"""The same joints give the same interval every time."""


@dataclass(frozen=True)
class PairedDifference:
    """Errors of a track minus those of a reference, px, over joints that both have.

    Attributes:
        joints: How many joints were compared.
        frames: In how many frames of recordings.
        mean: Of the track.
        reference_mean: Of the reference.
        difference: Of the means; below zero the track is better.
        low: Of the interval of `CONFIDENCE` around the difference.
        high: Its other end.
        better: Share of the joints where the track is nearer than the reference.
    """

    joints: int
    frames: int
    mean: float
    reference_mean: float
    difference: float
    low: float
    high: float
    better: float

    def to_json(self) -> dict[str, Any]:
        return asdict(self)


def find_common(evaluations: Sequence[Evaluation]) -> tuple[npt.NDArray[np.int64], list[Array]]:
    """(M,) frames and (M, 21) errors of each evaluation at the M hands that all have; NaN where any has no error."""
    assert evaluations
    rows = [
        {key: row for row, key in enumerate(zip(one.frame.tolist(), one.camera, one.hand, strict=True))}
        for one in evaluations
    ]
    keys = sorted(set.intersection(*map(set, rows)))
    errors = [
        one.error[[places[key] for key in keys]].reshape(len(keys), one.error.shape[1])
        for one, places in zip(evaluations, rows, strict=True)
    ]
    is_known = np.logical_and.reduce([np.isfinite(error) for error in errors])
    return np.array([key[0] for key in keys], dtype=np.int64), [np.where(is_known, error, np.nan) for error in errors]


def compare_paired(pairs: Sequence[tuple[Evaluation, Evaluation]]) -> PairedDifference | None:
    """A track against a reference, in one recording or pooled over several; None when no joint is in both.

    The interval is a bootstrap over frames: a frame's joints stand or fall together, so they are drawn together.
    Frames next to each other are not independent either; where every frame is annotated, the interval is too narrow.
    """
    sums, counts, errors, references = [], [], [], []
    for pair in pairs:
        frames, (own, other) = find_common(pair)
        is_known = np.isfinite(own)
        _, place = np.unique(frames, return_inverse=True)
        length = int(place.max()) + 1 if place.size else 0
        sums.append(np.bincount(place, np.where(is_known, own - other, 0.0).sum(axis=1), length))
        counts.append(np.bincount(place, is_known.sum(axis=1), length))
        errors.append(own[is_known])
        references.append(other[is_known])
    own, other = (np.concatenate(found) if found else np.zeros(0) for found in (errors, references))
    if own.size == 0:
        return None
    total, count = np.concatenate(sums), np.concatenate(counts)
    low, high = _resample(total[count > 0], count[count > 0])
    return PairedDifference(
        joints=len(own),
        frames=int(np.count_nonzero(count)),
        mean=float(own.mean()),
        reference_mean=float(other.mean()),
        difference=float((own - other).mean()),
        low=low,
        high=high,
        better=float(np.mean(own < other)),
    )


def _resample(sums: Array, counts: Array) -> tuple[float, float]:
    """The interval of the mean by a bootstrap: F frames are drawn from F with replacement, each with its joints."""
    rng = np.random.default_rng(SEED)
    frames = len(sums)
    means = np.empty(RESAMPLES)
    for start in range(0, RESAMPLES, 100):
        drawn = rng.integers(0, frames, (100, frames))
        means[start : start + 100] = sums[drawn].sum(axis=1) / counts[drawn].sum(axis=1)
    tail = 50 * (1 - CONFIDENCE)
    low, high = np.percentile(means, (tail, 100 - tail))
    return float(low), float(high)
