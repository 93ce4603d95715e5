"""One loop of dogleg steps: the minimum is found, every step lowers the cost, and it ends when it should."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from tracker.errors import SolveError
from tracker.solver.minimize import MOST_DAMPING, DenseSystem, TrustRegion, minimize, minimize_damped


@dataclass(frozen=True)
class Place:
    at: np.ndarray

    @property
    def residual(self) -> np.ndarray:
        """Of Rosenbrock's valley."""
        x, y = self.at
        return np.array([1.0 - x, 10.0 * (y - x * x)])

    @property
    def cost(self) -> float:
        return float(self.residual @ self.residual)


def linearize(place: Place) -> DenseSystem:
    J = np.array([[-1.0, 0.0], [-20.0 * place.at[0], 10.0]])
    return DenseSystem(J.T @ J, J.T @ place.residual)


class Walk:
    """Moves, and remembers where it was."""

    def __init__(self) -> None:
        self.tried: list[Place] = []

    def __call__(self, place: Place, step: np.ndarray) -> Place:
        self.tried.append(Place(place.at + step))
        return self.tried[-1]


START = Place(np.array([-1.2, 1.0]))


def test_the_floor_of_a_bent_valley_is_found_from_afar():
    found = minimize(START, linearize, Walk(), TrustRegion(0.5, 1e-9, 200, 1e-12))
    assert found.at == pytest.approx([1.0, 1.0], abs=1e-6)


def test_what_is_returned_never_costs_more_than_the_start_however_few_steps_are_allowed():
    costs = [minimize(START, linearize, Walk(), TrustRegion(0.5, 1e-9, n, 1e-12)).cost for n in range(12)]
    assert costs[0] == START.cost and costs == sorted(costs, reverse=True) and costs[-1] < costs[0]


def test_no_step_is_longer_than_the_region_and_no_more_are_tried_than_allowed():
    walk = Walk()
    minimize(START, linearize, walk, TrustRegion(0.1, 1e-9, 1, 1e-12))
    assert len(walk.tried) == 1
    assert np.linalg.norm(walk.tried[0].at - START.at) == pytest.approx(0.1)


def test_it_ends_where_steps_bring_less_than_the_tolerance():
    walk = Walk()
    minimize(Place(np.array([1.0 + 1e-9, 1.0])), linearize, walk, TrustRegion(1.0, 1e-12, 50, 1e3))
    assert not walk.tried


def test_equations_that_cannot_be_solved_end_it_where_it_is():
    def fail(place: Place) -> DenseSystem:
        return DenseSystem(-np.eye(2), place.residual)

    with pytest.raises(SolveError, match="positive definite"):
        fail(START)
    assert minimize(START, fail, Walk(), TrustRegion(1.0, 1e-9, 10, 1e-6)) is START


def test_where_every_step_is_worse_the_region_shrinks_until_it_gives_up():
    walk = Walk()

    def move(place: Place, step: np.ndarray) -> Place:
        return walk(place, -step)

    assert minimize(START, linearize, move, TrustRegion(1.0, 1e-3, 100, 1e-9)) is START
    lengths = [np.linalg.norm(place.at - START.at) for place in walk.tried]
    assert lengths == sorted(lengths, reverse=True) and 3 < len(lengths) < 20


def damp(place: Place, system: DenseSystem, damping: float) -> Place:
    H = system.hessian + damping * np.diag(np.diag(system.hessian))
    return Place(place.at - np.linalg.solve(H, system.gradient))


def test_damped_steps_find_the_same_floor_and_never_climb():
    costs = [minimize_damped(START, linearize, damp, n, 1e-15).cost for n in range(30)]
    assert costs[0] == START.cost and costs == sorted(costs, reverse=True)
    assert minimize_damped(START, linearize, damp, 200, 1e-15).at == pytest.approx([1.0, 1.0], abs=1e-6)


def test_damping_grows_while_steps_are_worse_and_the_equations_are_not_made_anew():
    dampings, made = [], []

    def climb(place: Place, equations: tuple[float, float], damping: float) -> Place:
        dampings.append(damping)
        return Place(place.at + 1.0 + damping)

    def equations_of(place: Place) -> tuple[float, float]:
        made.append(place)
        return (0.0, 0.0)

    assert minimize_damped(START, equations_of, climb, 100, 1e-6) is START
    assert len(made) == 1 and dampings == sorted(dampings) and max(dampings) <= MOST_DAMPING
