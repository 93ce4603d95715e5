"""A mixture finds the groups it was drawn from, and its cost is that of the best Gaussian alone."""

from __future__ import annotations

import numpy as np
from scipy.stats import multivariate_normal

from tracker.bodies.hand_mixture import HandMixture, default_mixture, fit_mixture


def test_groups_far_apart_are_found_with_their_shares() -> None:
    rng = np.random.default_rng(1)
    means = np.array([[3.0] * 12, [-3.0] * 12])
    drawn = means[rng.choice(2, 600, p=(0.75, 0.25))] + 0.2 * rng.standard_normal((600, 12))
    found = fit_mixture(drawn, 2)
    order = np.argsort(-found.shares)
    assert np.allclose(found.shares[order], (0.75, 0.25), atol=0.05)
    assert np.abs(found.means[order] - means).max() < 0.1


def test_the_cost_is_minus_twice_the_log_of_the_likeliest_gaussian_but_for_a_constant() -> None:
    mixture = default_mixture().first(6)
    rng = np.random.default_rng(2)
    points = mixture.means[rng.integers(len(mixture.shares), size=8)] + 0.2 * rng.standard_normal((8, 6))
    logs = [
        max(
            np.log(share) + multivariate_normal(mean, covariance).logpdf(point)
            for share, mean, covariance in zip(mixture.shares, mixture.means, mixture.covariances, strict=True)
        )
        for point in points
    ]
    costs = np.array([mixture.linearize(point)[0] for point in points])
    assert np.ptp(costs + 2.0 * np.array(logs)) < 1e-6 and costs.min() >= 0.0


def test_one_gaussian_has_the_mean_and_covariance_of_all() -> None:
    mixture = HandMixture(np.array([0.5, 0.5]), np.array([[1.0], [-1.0]]), np.array([[[0.25]], [[0.25]]]))
    one = mixture.as_one()
    assert np.allclose(one.means, 0.0) and np.allclose(one.covariances, 1.25)


def test_the_mixture_that_comes_along_holds_all_components_of_a_hand() -> None:
    mixture = default_mixture()
    assert mixture.num_coefficients == 45 and np.isclose(mixture.shares.sum(), 1.0, atol=1e-5)
    assert np.linalg.eigvalsh(mixture.covariances).min() > 0.0
