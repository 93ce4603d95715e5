"""What is known of a pose before the scan is seen, [R17] Eq. 8 and the pose-specific Gaussians of section 3.2."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.model.blend_limits import turn_jacobian

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class PosePrior:
    """A Gaussian over the joints behind the root, and soft limits.

    E = |W (θ - μ)|² + |max(0, (Lθ - high) / sd)|² + |max(0, (low - Lθ) / sd)|².

    Attributes:
        mean: (3K,) μ, rad.
        root: (R, 3K) W, so that W'W is the inverse covariance.
        axes: (M, 3K) L, angles with limits.
        low: (M,) rad.
        high: (M,) rad.
        limit_deviation: sd, by which a limit may be passed, rad.
    """

    mean: Array
    root: Array
    axes: Array
    low: Array
    high: Array
    limit_deviation: float = np.deg2rad(4.0)

    def linearize(self, theta: Array) -> tuple[float, Array, Array]:
        """Cost, JtJ (3K, 3K) and Jtr (3K,) by left-multiplied turns of the joints at theta (K, 3)."""
        flat = theta.ravel()
        residual = self.root @ (flat - self.mean)
        angles = self.axes @ flat
        beyond = np.maximum(angles - self.high, 0.0) - np.maximum(self.low - angles, 0.0)
        is_beyond = beyond != 0.0
        limits = self.axes[is_beyond] / self.limit_deviation
        excess = beyond[is_beyond] / self.limit_deviation
        turn = turn_jacobian(theta)
        rows = np.concatenate([self.root, limits])
        J = np.einsum("rka,kab->rkb", rows.reshape(len(rows), -1, 3), turn).reshape(len(rows), -1)
        r = np.concatenate([residual, excess])
        return float(r @ r), J.T @ J, J.T @ r

    def cost(self, theta: Array) -> float:
        """Cost alone."""
        flat = theta.ravel()
        residual = self.root @ (flat - self.mean)
        angles = self.axes @ flat
        beyond = (np.maximum(angles - self.high, 0.0) + np.maximum(self.low - angles, 0.0)) / self.limit_deviation
        return float(residual @ residual + beyond @ beyond)


def make_gaussian_prior(base: PosePrior, mean: Array, covariance: Array, strength: float = 1.0) -> PosePrior:
    """A prior for one pose of a protocol, [R17] section 3.2; the limits are those of `base`.

    Args:
        base: Where limits come from.
        mean: (3K,) rad.
        covariance: (3K, 3K) rad².
        strength: Factor on W.
    """
    floor = np.deg2rad(1.5) ** 2 * np.eye(len(mean))
    root = np.linalg.cholesky(np.linalg.inv(covariance + floor)).T
    return PosePrior(mean, strength * root, base.axes, base.low, base.high, base.limit_deviation)
