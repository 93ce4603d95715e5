"""Powell's dogleg step in a trust region, and how the region changes ([R17] section 3.2, Nocedal and Wright ch. 4)."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

ENOUGH = 0.05
"""A step is taken that brings this share of the decrease that the linearisation promised."""


def choose_dogleg_step(gradient: Array, newton: Array, curvature: float, radius: float) -> Array:
    """The point of the dogleg path at the rim of the trust region, or the Gauss-Newton step if that lies within.

    Parameters are to be scaled before, so that a ball is a fair region.

    Args:
        gradient: (D,) g of the cost.
        newton: (D,) Gauss-Newton step, -H⁻¹ g.
        curvature: g' H g.
        radius: Largest length of the step.
    """
    length = float(np.linalg.norm(newton))
    if length <= radius:
        return newton
    slope = float(gradient @ gradient)
    if slope == 0.0 or curvature <= 0.0:
        return newton * (radius / length)
    cauchy = -(slope / curvature) * gradient
    short = float(np.linalg.norm(cauchy))
    if short >= radius:
        return cauchy * (radius / short)
    leg = newton - cauchy
    a, b, c = float(leg @ leg), float(cauchy @ leg), short * short - radius * radius
    share = (-b + np.sqrt(max(b * b - a * c, 0.0))) / a
    return cauchy + share * leg


def choose_radius(radius: float, length: float, actual: float, promised: float) -> float:
    """The next radius: smaller after a poor prediction, larger after a good one at the rim.

    Args:
        radius: The one of this step.
        length: Length of the step.
        actual: Decrease of the cost.
        promised: Decrease of the linearised cost, positive.
    """
    ratio = actual / promised if promised > 0.0 else -1.0
    if ratio < 0.25:
        return 0.3 * min(radius, length)
    if ratio > 0.75 and length > 0.9 * radius:
        return 2.0 * radius
    return radius
