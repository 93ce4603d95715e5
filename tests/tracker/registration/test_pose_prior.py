"""Priors of a pose: the derivative is the cost's, limits push from outside only, a Gaussian counts as Mahalanobis."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tracker.model.blend_limits import blend_limits
from tracker.model.untrained_hand import untrained_hand
from tracker.registration.anatomy import make_anatomical_prior
from tracker.registration.pose_prior import make_gaussian_prior


@pytest.fixture(scope="module")
def prior():
    return make_anatomical_prior(untrained_hand())


def turned(theta: np.ndarray, step: np.ndarray) -> np.ndarray:
    """Every joint (K, 3) turned further from the left by step (K, 3), rad."""
    return (Rotation.from_rotvec(step) * Rotation.from_rotvec(theta)).as_rotvec()


@pytest.mark.parametrize("size", [0.1, 0.4, 0.8])
def test_the_gradient_is_that_of_the_cost_within_limits_and_beyond(prior, size):
    rng = np.random.default_rng(int(10 * size))
    theta = size * rng.normal(size=(15, 3))
    cost, JtJ, Jtr = prior.linearize(theta)
    assert cost == pytest.approx(prior.cost(theta))
    assert JtJ == pytest.approx(JtJ.T) and np.linalg.eigvalsh(JtJ).min() > 0.0
    for _ in range(5):
        step = rng.normal(size=(15, 3))
        ahead, behind = (prior.cost(turned(theta, sign * 1e-6 * step)) for sign in (1.0, -1.0))
        assert (ahead - behind) / 2e-6 == pytest.approx(2.0 * Jtr @ step.ravel(), rel=1e-4, abs=1e-3)


def test_the_anatomical_prior_is_least_at_the_mean_pose_and_cheapest_in_flexion(prior):
    limits = blend_limits(untrained_hand())
    mean = limits.pose_at(limits.mean)
    assert prior.cost(mean[1:]) == pytest.approx(0.0, abs=1e-12)
    costs = []
    for motion in range(3):
        angles = limits.mean.copy()
        angles[3, motion] += np.radians(10.0)  # the middle finger's first joint
        costs.append(prior.cost(limits.pose_at(angles)[1:]))
    flexion, abduction, twist = costs
    assert 0.0 < flexion < 0.2 * abduction and abduction < twist


def test_limits_cost_beyond_them_and_nothing_within(prior):
    limits = blend_limits(untrained_hand())
    free = make_gaussian_prior(prior, prior.mean, 1e6 * np.eye(45))
    assert free.cost(limits.pose_at(0.5 * (limits.lower + limits.upper))[1:]) < 1e-4
    beyond = limits.upper.copy()
    beyond[4, 0] += np.radians(8.0)
    assert free.cost(limits.pose_at(beyond)[1:]) == pytest.approx(4.0, rel=1e-3)  # 8 degrees at a deviation of 4
    below = limits.lower.copy()
    below[4, 0] -= np.radians(4.0)
    assert free.cost(limits.pose_at(below)[1:]) == pytest.approx(1.0, rel=1e-3)


def test_a_gaussian_counts_the_distance_by_its_covariance(prior):
    rng = np.random.default_rng(2)
    root = 0.05 * rng.normal(size=(45, 45))
    covariance = root @ root.T
    gaussian = make_gaussian_prior(prior, prior.mean, covariance, strength=2.0)
    floor = np.radians(1.5) ** 2 * np.eye(45)
    away = 0.01 * rng.normal(size=45)
    expected = 4.0 * away @ np.linalg.solve(covariance + floor, away)
    assert gaussian.cost((prior.mean + away).reshape(-1, 3)) == pytest.approx(expected, rel=1e-6)


def test_a_covariance_without_rank_is_a_prior_too(prior):
    gaussian = make_gaussian_prior(prior, prior.mean, np.zeros((45, 45)))
    one_deviation = prior.mean.copy()
    one_deviation[0] += np.radians(1.5)
    assert gaussian.cost(one_deviation.reshape(-1, 3)) == pytest.approx(1.0, rel=1e-6)
