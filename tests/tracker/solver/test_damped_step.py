"""The step solves what it should, never leaves its limits and says when there is nothing to solve."""

import numpy as np
import pytest

from tracker.errors import SolveError
from tracker.solver.damped_step import compute_damped_step

FREE = np.full(3, 1e9)


def random_system(rng):
    J, r = rng.normal(size=(10, 3)), rng.normal(size=10)
    return J, r, J.T @ J, J.T @ r


def test_without_damping_it_is_the_least_squares_solution(rng):
    J, r, JtJ, Jtr = random_system(rng)
    expected = np.linalg.lstsq(J, -r, rcond=None)[0]
    np.testing.assert_allclose(compute_damped_step(JtJ, Jtr, 0.0, FREE), expected, rtol=1e-6)


def test_more_damping_gives_a_shorter_step_that_still_descends(rng):
    _, _, JtJ, Jtr = random_system(rng)
    lengths = [np.linalg.norm(compute_damped_step(JtJ, Jtr, damping, FREE)) for damping in (0.0, 0.1, 10.0)]
    assert lengths[0] > lengths[1] > lengths[2] > 0.0
    assert compute_damped_step(JtJ, Jtr, 10.0, FREE) @ Jtr < 0.0


def test_limits_shorten_the_step_but_keep_its_direction(rng):
    _, _, JtJ, Jtr = random_system(rng)
    free, limited = (compute_damped_step(JtJ, Jtr, 1e-3, limits) for limits in (FREE, np.array([1e-3, 1.0, 1.0])))
    assert abs(limited[0]) <= 1e-3 * (1 + 1e-12)
    np.testing.assert_allclose(limited / np.linalg.norm(limited), free / np.linalg.norm(free), rtol=1e-9)


def test_what_nothing_observes_stays_where_it_is():
    step = compute_damped_step(np.diag([4.0, 0.0, 0.0]), np.array([2.0, 0.0, 0.0]), 0.0, FREE)
    np.testing.assert_allclose(step, [-0.5, 0.0, 0.0], atol=1e-6)


def test_a_matrix_that_rounding_made_indefinite_is_still_solved():
    JtJ = np.diag([1.0, 1.0, -1e-8])
    assert np.isfinite(compute_damped_step(JtJ, np.ones(3), 0.0, np.ones(3))).all()


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_equations_that_are_not_finite_are_refused(bad):
    with pytest.raises(SolveError, match="not finite"):
        compute_damped_step(np.full((3, 3), bad), np.ones(3), 0.0, FREE)
