"""Residual kind: functions of the joint angles alone, [T16] Eq. 17 and 18."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from tracker.terms.look import TermLook

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class AnatomicalLimits:
    """Soft joint limits, E = Σ_k exp(p(l_k − θ_k)) + exp(p(θ_k − u_k)), [T16] Eq. 17.

    Weighted by γ_a C_all, C_all the number of correspondences of the other terms. As a sum of squares the residuals are
    exp(p/2 (l − θ)) and exp(p/2 (θ − u)), which is Eq. 17 exactly.

    Differs from the paper: beyond `linear_from` the residual goes on as its tangent, so that a start far outside its
    limits cannot overflow.
    """

    look: ClassVar[TermLook] = TermLook("anatomy", "Anatomy", "#b4b469", "#4b2d1e", (4, 2))

    weight: float = 0.0015
    """γ_a (§3.2.7), times C_all."""

    steepness: float = 10.0
    """p (§3.2.7), 1/rad."""

    linear_from: float = 0.35
    """Outside the limits by more than this the residual is linear, rad."""

    def linearize(self, angles: Array, lower: Array, upper: Array) -> tuple[float, Array, Array]:
        """Cost, gradient (K,) and Gauss-Newton curvature (K,) of Eq. 17 without its weight.

        Args:
            angles: (K,) rad.
            lower: (K,) rad.
            upper: (K,) rad.
        """
        cost, gradient, curvature = 0.0, np.zeros_like(angles), np.zeros_like(angles)
        for outside, sign in ((lower - angles, -1.0), (angles - upper, 1.0)):
            bounded = np.minimum(outside, self.linear_from)
            value = np.exp(0.5 * self.steepness * bounded)
            slope = 0.5 * self.steepness * value
            value = value + slope * (outside - bounded)
            cost += float(np.sum(value**2))
            gradient += sign * slope * value
            curvature += slope**2
        return cost, gradient, curvature


@dataclass(frozen=True)
class Regularization:
    """Stay near the angles of the previous frame, E = Σ_k (θ_k − θ̃_k)², [T16] Eq. 18, weighted by γ_r C_all."""

    look: ClassVar[TermLook] = TermLook("regularization", "Regularization", "#7887f0", "#4b5a96", (2, 2))

    weight: float = 0.02
    """γ_r (§3.2.8), times C_all."""

    def linearize(self, angles: Array, previous: Array) -> tuple[float, Array, Array]:
        """Cost, gradient (K,) and curvature (K,) of Eq. 18 without its weight; angles and previous (K,) rad."""
        difference = angles - previous
        return float(np.sum(difference**2)), difference, np.ones_like(angles)


@dataclass(frozen=True)
class Bending:
    """Bend a chain evenly, E = Σ (θ_k − θ_k')² over joints k of an object and the like joint k' of the bone before.

    Weighted by its weight times C_all. Differs from the paper, which has no such term: each joint of a rope is held by
    two hundred pixels only, and nothing in a depth image tells a rope from one that is shorter for its zigzags. With it
    a rope behaves as a thin rod, whose energy is in the change of its curvature; a single hinge is left alone.
    """

    look: ClassVar[TermLook] = TermLook("bending", "Bending", "#b4d2c3", "#3c0069", (12, 3, 3, 3))

    weight: float = 0.1
    """Times C_all."""

    def linearize(self, angles: Array, before: Array) -> tuple[float, Array, Array]:
        """Cost, gradient (K,) by `angles` and curvature (K,) without its weight; by `before` the gradient is opposite.

        Args:
            angles: (K,) rad.
            before: (K,) of the joints before, rad.
        """
        difference = angles - before
        return float(np.sum(difference**2)), difference, np.ones_like(angles)
