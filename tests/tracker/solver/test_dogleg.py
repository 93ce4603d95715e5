"""Steps within a trust region."""

from __future__ import annotations

import numpy as np
import pytest

from tracker.solver.dogleg import choose_dogleg_step, choose_radius


@pytest.fixture
def problem():
    rng = np.random.default_rng(3)
    A = rng.standard_normal((6, 6))
    H = A @ A.T + 0.1 * np.eye(6)
    g = rng.standard_normal(6)
    return H, g, -np.linalg.solve(H, g)


def promised(H, g, step):
    return -(2.0 * g @ step + step @ H @ step)


def test_within_a_large_region_the_step_is_gauss_newtons(problem):
    H, g, newton = problem
    assert choose_dogleg_step(g, newton, g @ H @ g, 100.0) is newton


def test_the_step_ends_at_the_rim_and_promises_more_the_larger_the_region(problem):
    H, g, newton = problem
    lengths = np.linalg.norm(newton) * np.array([1e-3, 0.1, 0.3, 0.6, 0.9])
    gains = []
    for radius in lengths:
        step = choose_dogleg_step(g, newton, g @ H @ g, radius)
        assert np.linalg.norm(step) == pytest.approx(radius, rel=1e-9)
        gains.append(promised(H, g, step))
    assert gains == sorted(gains) and gains[0] > 0.0


def test_a_tiny_region_leaves_steepest_descent(problem):
    H, g, newton = problem
    step = choose_dogleg_step(g, newton, g @ H @ g, 1e-6)
    assert step @ g == pytest.approx(-np.linalg.norm(step) * np.linalg.norm(g))


def test_the_region_shrinks_after_a_poor_prediction_and_grows_after_a_good_one_at_its_rim():
    assert choose_radius(1.0, 0.8, -0.1, 1.0) == pytest.approx(0.24)
    assert choose_radius(1.0, 1.0, 0.9, 1.0) == 2.0
    assert choose_radius(1.0, 0.5, 0.9, 1.0) == 1.0
    assert choose_radius(1.0, 1.0, 0.5, 1.0) == 1.0
