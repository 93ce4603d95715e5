"""How hands are held before a scan is seen: a mixture of Gaussians over the pose space, [R17] Eq. 17-19."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

DATA = Path(__file__).parent / "data" / "hand_mixture.npz"

CLUSTERED = 10
"""So many coefficients decide to which Gaussian a pose belongs: 90 % of the space ([R17] 5.1)."""
FLOOR = np.deg2rad(1.5) ** 2
"""Least variance of a coefficient, rad²: of a protocol's poses, not all that people do."""


@dataclass(frozen=True, eq=False)
class HandMixture:
    """Gaussians over the first C coefficients of a hand's pose space.

    The sum over them is replaced by the largest, [R17] Eq. 18, so that wherever a hand is the cost is that of one
    Gaussian: 2 min_j (-log(g_j N(a; μ_j, Σ_j))), less the least value of it.

    Attributes:
        shares: (G,) g, sum to one.
        means: (G, C) μ, rad.
        covariances: (G, C, C) Σ, rad².
    """

    shares: Array
    means: Array
    covariances: Array

    def __post_init__(self) -> None:
        count, size = self.means.shape
        assert self.shares.shape == (count,) and self.covariances.shape == (count, size, size)

    @property
    def num_coefficients(self) -> int:
        return self.means.shape[1]

    def first(self, count: int) -> HandMixture:
        """The same of the first `count` coefficients alone."""
        return HandMixture(self.shares, self.means[:, :count], self.covariances[:, :count, :count])

    def as_one(self) -> HandMixture:
        """One Gaussian with the mean and covariance of the whole."""
        mean = self.shares @ self.means
        apart = self.means - mean
        covariance = np.einsum("g,gxy->xy", self.shares, self.covariances + np.einsum("gx,gy->gxy", apart, apart))
        return HandMixture(np.ones(1), mean[None], covariance[None])

    def linearize(self, coefficients: Array) -> tuple[float, Array, Array]:
        """Cost, JtJ (C, C) and Jtr (C,) at coefficients (C,)."""
        inverses, offsets = self._parts
        apart = coefficients - self.means
        costs = np.einsum("gx,gxy,gy->g", apart, inverses, apart) + offsets
        best = int(np.argmin(costs))
        return float(costs[best]), inverses[best], inverses[best] @ apart[best]

    @cached_property
    def _parts(self) -> tuple[Array, Array]:
        """Inverse covariances (G, C, C), and what is added to each Gaussian's distance (G,); the least of that is 0."""
        offsets: Array = np.linalg.slogdet(self.covariances)[1] - 2.0 * np.log(self.shares)
        return np.asarray(np.linalg.inv(self.covariances), dtype=np.float64), offsets - offsets.min()


@cache
def default_mixture() -> HandMixture:
    """Of ten Gaussians over a right hand's 45 coefficients, made by `scripts/build_hand_poses.py`; also a left one's,
    whose pose space is the mirror image."""
    with np.load(DATA, allow_pickle=False) as arrays:
        return HandMixture(*(arrays[name].astype(np.float64) for name in ("shares", "means", "covariances")))


def fit_mixture(coefficients: Array, count: int, rounds: int = 60, seed: int = 0) -> HandMixture:
    """A mixture by expectation and maximisation.

    Args:
        coefficients: (N, C) of N hands, the largest components first, rad.
        count: G.
        rounds: Of both steps.
        seed: Of the starts, each far from those before.
    """
    few = coefficients[:, :CLUSTERED]
    rng = np.random.default_rng(seed)
    means = few[[int(rng.integers(len(few)))]]
    while len(means) < count:
        nearest = np.min(np.sum((few[:, None] - means) ** 2, axis=2), axis=1)
        means = np.concatenate([means, few[[int(rng.choice(len(few), p=nearest / nearest.sum()))]]])
    shares, covariances = np.full(count, 1.0 / count), np.tile(np.cov(few.T) / count, (count, 1, 1))
    belongs = np.zeros((len(few), count))
    for _ in range(rounds):
        apart = few[:, None] - means
        logs = np.log(shares) - 0.5 * np.linalg.slogdet(covariances)[1]
        logs = logs - 0.5 * np.einsum("ngx,gxy,ngy->ng", apart, np.linalg.inv(covariances), apart)
        belongs = np.exp(logs - logs.max(axis=1, keepdims=True))
        belongs /= belongs.sum(axis=1, keepdims=True)
        shares, means, covariances = _maximize(few, belongs)
    return HandMixture(*_maximize(coefficients, belongs))


def _maximize(coefficients: Array, belongs: Array) -> tuple[Array, Array, Array]:
    """Shares, means and covariances of hands (N, C) that belong to Gaussians (N, G)."""
    sizes = belongs.sum(axis=0) + 1e-9
    means = (belongs.T @ coefficients) / sizes[:, None]
    apart = coefficients[:, None] - means
    covariances = np.einsum("ng,ngx,ngy->gxy", belongs, apart, apart) / sizes[:, None, None]
    size = coefficients.shape[1]
    pooled = np.einsum("g,gxy->xy", sizes, covariances) / sizes.sum()
    trust = sizes / (sizes + 2.0 * size)  # few hands tell little of a covariance: the rest is all Gaussians' together
    mixed = trust[:, None, None] * covariances + (1.0 - trust)[:, None, None] * pooled
    return sizes / sizes.sum(), means, mixed + FLOOR * np.eye(size)
