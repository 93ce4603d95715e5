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
        p95: 95 % are below.
        max: Largest.
    """

    count: int
    mean: float | None = None
    std: float | None = None
    median: float | None = None
    p95: float | None = None
    max: float | None = None

    def to_json(self) -> dict[str, float | int | None]:
        return asdict(self)


def compute_statistics(errors: npt.NDArray[np.float64]) -> Statistics:
    """Statistics of errors of any shape; NaN stands for "no error known" and is left out."""
    known = errors[np.isfinite(errors)]
    if known.size == 0:
        return Statistics(0)
    return Statistics(
        count=int(known.size),
        mean=float(np.mean(known)),
        std=float(np.std(known)),
        median=float(np.median(known)),
        p95=float(np.percentile(known, 95)),
        max=float(np.max(known)),
    )
