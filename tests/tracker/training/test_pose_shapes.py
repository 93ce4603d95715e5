"""Pose blend shapes: what unposed registrations of one hand differ by, held the more the farther from the joint."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse import csr_array

from tests.tracker.training.fingers import PARENTS, crude_regressor, make_fingers, make_tube, make_weights
from tracker.training.pose_shapes import FLOOR, REACH, _solve, compute_costs, fit_pose_shapes, measure_from_joints
from tracker.training.regressor import fit_joint_regressor


@pytest.fixture
def registered():
    """Features, unposed registrations and owners of three hands, with noise."""
    rng = np.random.default_rng(5)
    owners = np.array([0, 0, 0, 0, 0, 1, 1, 1, 1, 2])
    return rng.normal(size=(10, 18)), rng.normal(size=(10, 7, 3)), owners


def test_blend_shapes_are_found_again_and_a_template_may_hold_any_constant():
    rng = np.random.default_rng(0)
    features, truth = rng.normal(size=(200, 18)), 0.001 * rng.normal(size=(30, 3, 18))
    owners = np.repeat(np.arange(10), 20)
    rest = rng.normal(size=(10, 30, 3))[owners] + np.einsum("vin,mn->mvi", truth, features)
    found = fit_pose_shapes(features, rest, owners, np.ones((30, 18)), 1e-9)
    np.testing.assert_allclose(found, truth, atol=1e-9)


def test_blend_shapes_far_from_a_joint_cost_more():
    tube, _ = make_tube()
    fingers = make_fingers(people=3, poses=1)
    regressor = fit_joint_regressor(fingers.templates, fingers.joints, make_weights(tube[:, 0], 0.008), PARENTS)
    costs = compute_costs(measure_from_joints(tube, regressor))
    assert costs.shape == (len(tube), 27)
    tip, knuckle = np.argmax(tube[:, 0]), np.argmin(np.abs(tube[:, 0] - 0.03))
    assert costs[tip, 0] > 4.0 * costs[knuckle, 0]
    assert (costs[:, 0:9] == costs[:, [0]]).all()


def test_ridge_systems_are_solved_as_numpy_solves_them_also_with_hardly_any_data():
    rng = np.random.default_rng(4)
    for samples in (3, 200):
        features, sides = rng.normal(size=(samples, 36)), rng.normal(size=(36, 15))
        penalties = rng.uniform(1e-6, 2.0, (5, 36))
        found = _solve(features.T @ features, sides, penalties)
        for v in range(5):
            expected = np.linalg.solve(features.T @ features + np.diag(penalties[v]), sides[:, 3 * v : 3 * v + 3])
            np.testing.assert_allclose(
                found[:, 3 * v : 3 * v + 3], expected, rtol=1e-6, atol=1e-9 * abs(expected).max()
            )


def test_distances_from_a_joint_are_means_over_the_vertices_it_is_averaged_from():
    tube, _ = make_tube()
    distances = measure_from_joints(tube, crude_regressor(tube))
    assert distances.shape == (3, len(tube)), "the root has no pose blend shapes"
    for joint, row in enumerate(crude_regressor(tube).toarray()[1:]):
        ring = np.flatnonzero(row)
        for vertex in (0, 57, len(tube) - 1):
            plain = np.mean([np.linalg.norm(tube[vertex] - tube[source]) for source in ring])
            assert distances[joint, vertex] == pytest.approx(plain)


def test_a_joint_at_one_vertex_is_at_no_distance_from_it():
    tube, _ = make_tube()
    rows = np.zeros((2, len(tube)))
    rows[0, 0] = rows[1, 33] = 1.0
    distances = measure_from_joints(tube, csr_array(rows))
    assert distances[0, 33] == 0.0
    np.testing.assert_allclose(distances[0], np.linalg.norm(tube - tube[33], axis=1))


def test_costs_grow_with_the_square_of_the_distance_and_are_the_usual_one_at_their_reach():
    costs = compute_costs(np.array([[0.0, REACH, 2.0 * REACH], [REACH, 0.0, REACH]]))
    np.testing.assert_allclose(costs[:, 0], [FLOOR, 1.0 + FLOOR, 4.0 + FLOOR])
    np.testing.assert_allclose(costs[:, 9], [1.0 + FLOOR, FLOOR, 1.0 + FLOOR])
    assert costs.shape == (3, 18) and (costs[:, :9] == costs[:, [0]]).all() and (costs[:, 9:] == costs[:, [9]]).all()


def test_no_other_shapes_do_better_against_the_ridge(registered):
    """The gradient of the whole objective, each hand's template free, is nothing."""
    features, rest, owners = registered
    costs = np.random.default_rng(6).uniform(0.1, 2.0, (7, 18))
    found = fit_pose_shapes(features, rest, owners, costs, 1e-2)

    def price(directions: np.ndarray) -> float:
        left = rest - np.einsum("vin,mn->mvi", directions, features)
        spread = sum(np.sum((left[owners == k] - left[owners == k].mean(0)) ** 2) for k in range(3))
        return spread + 1e-2 * len(rest) * float(np.sum(costs[:, None] * directions**2))

    rng, least = np.random.default_rng(7), price(found)
    for _ in range(20):
        way = rng.normal(size=found.shape)
        assert price(found + 1e-3 * way) > least
        slope = (price(found + 1e-5 * way) - price(found - 1e-5 * way)) / 2e-5
        assert slope == pytest.approx(0.0, abs=1e-6)


def test_a_hand_of_one_registration_and_the_order_of_registrations_say_nothing(registered):
    features, rest, owners = registered
    costs = np.ones((7, 18))
    found = fit_pose_shapes(features, rest, owners, costs, 1e-2)
    order = np.random.default_rng(8).permutation(10)
    shuffled = fit_pose_shapes(features[order], rest[order], owners[order], costs, 1e-2)
    np.testing.assert_allclose(shuffled, found, atol=1e-12)
    kept = owners != 2
    fewer = fit_pose_shapes(features[kept], rest[kept], owners[kept], costs, 1e-2 * 10 / 9)
    np.testing.assert_allclose(fewer, found, atol=1e-12)


def test_what_costs_more_is_smaller_and_hands_that_differ_by_nothing_have_no_shapes(registered):
    features, rest, owners = registered
    sizes = [np.abs(fit_pose_shapes(features, rest, owners, np.ones((7, 18)), r)).sum() for r in (1e-3, 1.0, 1e6)]
    assert sizes[0] > sizes[1] > 1e3 * sizes[2]
    same = np.tile(rest[:1], (10, 1, 1))
    np.testing.assert_allclose(fit_pose_shapes(features, same, owners, np.ones((7, 18)), 1e-3), 0.0, atol=1e-12)


def test_the_registrations_that_were_given_stay_as_they_are(registered):
    features, rest, owners = registered
    before = features.copy(), rest.copy()
    fit_pose_shapes(features, rest, owners, np.ones((7, 18)), 1e-2)
    np.testing.assert_array_equal(features, before[0])
    np.testing.assert_array_equal(rest, before[1])
