"""What values of a recording usually are, and how far one may be from that."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from server.quality.labels import find_median

Array = npt.NDArray[np.float64]

SPREADS = 6.0
"""A value this many standard deviations from the median is another one's, not noise: of 21 joints in a thousand frames
none is, were the noise Gaussian; a detector's noise has longer tails than that."""


def find_usual(table: Array) -> tuple[Array, Array]:
    """The median of each column of (N, K) and its robust standard deviation, (K,) each; NaN where nothing is known."""
    usual = find_median(table, axis=0)
    return usual, 1.4826 * find_median(np.abs(table - usual), axis=0)


def compare_with_usual(table: Array, least: Array) -> tuple[Array, Array]:
    """How far values are beyond what is usual for their column.

    Args:
        table: (N, K) distances.
        least: (N,) no distance below this counts as unusual.

    Returns:
        (N, K) values over their limit, more than 1 being unusual, and (K,) what is usual.
    """
    usual, spread = find_usual(table)
    return table / np.maximum(usual + SPREADS * spread, least[:, None]), usual
