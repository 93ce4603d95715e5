"""Which views of a joint to believe: those whose rays meet where most rays meet."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

MEETS = 0.015
"""m; a ray so near to a place agrees with it, as `view_hands.REACH`."""

ENOUGH = 3
"""This many rays that agree are believed against others; of two that cross it is unknown which are right."""

PARALLEL = 1e-4
"""Squared sine of the angle below which two rays tell no place."""


def find_believed(origins: Array, directions: Array) -> tuple[npt.NDArray[np.bool_], npt.NDArray[np.bool_]]:
    """(N, C) which rays of each joint to believe, and which of those agree with two others.

    All are believed, unless `ENOUGH` meet in one place and others pass it by.

    Places that are tried are the midpoints between every two rays of a joint; the one near most rays wins, and of two
    the one that is nearer to its rays.

    Args:
        origins: (C, 3) of the cameras, m.
        directions: (N, C, 3) unit, of each joint's ray in each view; NaN where there is none. The frame of `origins`.
    """
    count, views = directions.shape[:2]
    believed, supported = np.ones((count, views), dtype=np.bool_), np.zeros((count, views), dtype=np.bool_)
    pairs = np.array(list(combinations(range(views), 2)), dtype=np.int64).reshape(-1, 2)
    if views <= ENOUGH - 1 or not count:
        return believed, supported
    a, b = directions[:, pairs[:, 0]], directions[:, pairs[:, 1]]  # (N, P, 3)
    between = origins[pairs[:, 1]] - origins[pairs[:, 0]]
    cosine = np.einsum("npi,npi->np", a, b)
    sine = np.where(1.0 - cosine**2 > PARALLEL, 1.0 - cosine**2, np.nan)
    along_a, along_b = np.einsum("npi,pi->np", a, between), np.einsum("npi,pi->np", b, between)
    s = (along_a - cosine * along_b) / sine
    t = (cosine * along_a - along_b) / sine
    places = 0.5 * (origins[pairs[:, 0]] + s[:, :, None] * a + origins[pairs[:, 1]] + t[:, :, None] * b)
    to_places = places[:, :, None] - origins  # (N, P, C, 3)
    apart = np.linalg.norm(np.cross(to_places, directions[:, None]), axis=3)
    near = np.where(np.isfinite(apart), np.minimum((apart / MEETS) ** 2, 1.0), 1.0)
    best = near.sum(axis=2).argmin(axis=1)
    agrees = near[np.arange(count), best] < 1.0
    is_clear = agrees.sum(axis=1) >= ENOUGH
    believed[is_clear] = supported[is_clear] = agrees[is_clear]
    return believed, supported
