"""The numbers that tables of errors show."""

from __future__ import annotations

from dataclasses import asdict, dataclass

import numpy as np
import numpy.typing as npt


@dataclass(frozen=True)
class Statistics:
    """Of a set of errors, in their unit; all None but `count` where there are none.

    Attributes:
        count: How many errors.
        mean: Mean.
        std: Standard deviation.
        median: Half are below.
        p75: 75 % are below.
        p95: 95 % are below.
        p99: 99 % are below.
        max: Largest.
    """

    count: int
    mean: float | None = None
    std: float | None = None
    median: float | None = None
    p75: float | None = None
    p95: float | None = None
    p99: float | None = None
    max: float | None = None

    def to_json(self) -> dict[str, float | int | None]:
        return asdict(self)


def compute_statistics(errors: npt.NDArray[np.float64]) -> Statistics:
    """Statistics of errors of any shape; NaN stands for "no error known" and is left out."""
    known = errors[np.isfinite(errors)]
    if known.size == 0:
        return Statistics(0)
    median, p75, p95, p99 = (float(value) for value in np.percentile(known, (50, 75, 95, 99)))
    return Statistics(
        count=int(known.size),
        mean=float(np.mean(known)),
        std=float(np.std(known)),
        median=median,
        p75=p75,
        p95=p95,
        p99=p99,
        max=float(np.max(known)),
    )


def compute_shares_below(
    errors: npt.NDArray[np.float64], thresholds: npt.NDArray[np.float64]
) -> npt.NDArray[np.float64]:
    """Share of the known errors that are at most each threshold (PCK); NaN where no error is known."""
    known = np.sort(errors[np.isfinite(errors)])
    if known.size == 0:
        return np.full(len(thresholds), np.nan)
    return np.searchsorted(known, thresholds, side="right") / known.size
