"""Limits and regularisation are Eq. 17 and Eq. 18 and have their derivatives."""

import numpy as np
import pytest

from tracker.terms.joint_prior import AnatomicalLimits, Regularization


def test_limits_are_the_sum_of_exponentials_of_the_paper(rng):
    angles = rng.uniform(-1.0, 1.0, size=8)
    lower, upper = np.full(8, -0.8), np.full(8, 0.8)
    cost, _, _ = AnatomicalLimits().linearize(angles, lower, upper)
    paper = np.sum(np.exp(10 * (lower - angles)) + np.exp(10 * (angles - upper)))
    assert cost == pytest.approx(paper, rel=1e-12)


def test_limits_far_outside_do_not_overflow():
    cost, gradient, curvature = AnatomicalLimits().linearize(np.array([300.0]), np.array([-1.0]), np.array([1.0]))
    assert np.isfinite(cost)
    assert np.isfinite(gradient).all()
    assert np.isfinite(curvature).all()


@pytest.mark.parametrize("angle", [-1.5, -0.79, 0.0, 0.5, 0.85, 1.4])
def test_gradients_agree_with_finite_differences(angle):
    angles, lower, upper = np.array([angle]), np.array([-0.8]), np.array([0.8])
    step = 1e-6
    for linearize in (
        lambda a: AnatomicalLimits().linearize(a, lower, upper),
        lambda a: Regularization().linearize(a, np.array([0.2])),
    ):
        _, gradient, _ = linearize(angles)
        numeric = (linearize(angles + step)[0] - linearize(angles - step)[0]) / (2 * step) / 2  # of half the cost
        assert gradient[0] == pytest.approx(numeric, rel=1e-5, abs=1e-8)
