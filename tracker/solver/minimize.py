"""Loops of steps: dogleg ([R17] section 3.2) and Levenberg-Marquardt; Nocedal and Wright ch. 4 and 10."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol, TypeVar

import numpy as np
import numpy.typing as npt
from scipy.linalg import cho_factor, cho_solve

from tracker.errors import SolveError
from tracker.solver.dogleg import ENOUGH, choose_dogleg_step, choose_radius

Array = npt.NDArray[np.float64]


class Point(Protocol):
    """Where a minimisation may be."""

    @property
    def cost(self) -> float: ...


class System(Protocol):
    """Normal equations of one linearisation, in parameters scaled so that a ball is a fair trust region."""

    @property
    def gradient(self) -> Array:
        """(D,) half the derivative of the cost."""
        ...

    @property
    def newton(self) -> Array:
        """(D,) Gauss-Newton step."""
        ...

    def curvature(self, step: Array) -> float:
        """step' H step."""
        ...


@dataclass(frozen=True)
class TrustRegion:
    """How a minimisation begins and ends.

    Attributes:
        radius: Largest first step.
        least: It ends when steps would have to be shorter than this.
        iterations: Steps tried at most.
        tolerance: It ends when a step brings less than this share of the cost.
    """

    radius: float
    least: float
    iterations: int
    tolerance: float


class DenseSystem:
    """Normal equations held as a matrix.

    Args:
        hessian: (D, D) H, positive definite.
        gradient: (D,) g.

    Raises:
        SolveError: H is not positive definite.
    """

    def __init__(self, hessian: Array, gradient: Array) -> None:
        self.hessian, self.gradient = hessian, gradient
        try:
            factor = cho_factor(hessian, lower=True, check_finite=False)
        except np.linalg.LinAlgError as error:
            raise SolveError("The normal equations are not positive definite.") from error
        self.newton: Array = -cho_solve(factor, gradient, check_finite=False)

    def curvature(self, step: Array) -> float:
        return float(step @ self.hessian @ step)


P = TypeVar("P", bound=Point)
E = TypeVar("E")

FIRST_DAMPING, LEAST_DAMPING, MOST_DAMPING = 1e-4, 1e-8, 1e4
"""Share of the diagonal that Levenberg-Marquardt adds at first, at least, and before it gives up."""


def minimize(start: P, linearize: Callable[[P], System], move: Callable[[P, Array], P], region: TrustRegion) -> P:
    """The best point that dogleg steps find. Equations that cannot be solved end it where it is.

    Args:
        start: Where to begin.
        linearize: Normal equations at a point; may raise SolveError.
        move: The point after a step (D,), evaluated.
        region: How to begin and end.
    """
    here, radius = start, region.radius
    system: System | None = None
    for _ in range(region.iterations):
        if system is None:
            try:
                system = linearize(here)
            except SolveError:
                break
        gradient, newton = system.gradient, system.newton
        is_longer = float(np.linalg.norm(newton)) > radius
        step = choose_dogleg_step(gradient, newton, system.curvature(gradient) if is_longer else 0.0, radius)
        promised = -float(2.0 * (gradient @ step)) - system.curvature(step)
        if not np.isfinite(promised) or promised <= 0.2 * region.tolerance * here.cost:
            break
        there = move(here, step)
        decrease = here.cost - there.cost
        radius = choose_radius(radius, float(np.linalg.norm(step)), decrease, promised)
        if decrease > ENOUGH * promised:
            is_done = decrease < region.tolerance * here.cost
            here, system = there, None
            if is_done:
                break
        elif radius < region.least:
            break
    return here


def minimize_damped(
    start: P, linearize: Callable[[P], E], step: Callable[[P, E, float], P], iterations: int, tolerance: float
) -> P:
    """The best point that Levenberg-Marquardt steps find.

    Args:
        start: Where to begin.
        linearize: Equations at a point, whatever `step` takes.
        step: The point that the equations of a point lead to with a damping, evaluated.
        iterations: Steps tried at most.
        tolerance: It ends when a step brings less than this share of the cost.
    """
    here, damping = start, FIRST_DAMPING
    equations: E | None = None
    for _ in range(iterations):
        if equations is None:
            equations = linearize(here)
        there = step(here, equations, damping)
        if there.cost >= here.cost:
            damping *= 10.0
            if damping > MOST_DAMPING:
                break
            continue
        is_done = here.cost - there.cost < tolerance * here.cost
        here, equations, damping = there, None, max(LEAST_DAMPING, 0.1 * damping)
        if is_done:
            break
    return here
