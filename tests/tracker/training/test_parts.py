"""Linear parts of training: weights, regressor, blend shapes, spaces, Eq. 11."""

import numpy as np
import pytest
from scipy.optimize import nnls

from tests.tracker.training.fingers import PARENTS, make_fingers, make_tube, make_weights
from tracker.training.blend_weights import find_weights, solve_nonnegative
from tracker.training.pose_fit import Poses
from tracker.training.pose_shapes import _solve, compute_costs, fit_pose_shapes, measure_from_joints
from tracker.training.regressor import fit_joint_regressor
from tracker.training.spaces import align_rigidly, find_shape_space, find_space
from tracker.training.templates import weigh_by_pose


@pytest.mark.parametrize("seed", range(8))
def test_nonnegative_least_squares_agree_with_scipy(seed):
    rng = np.random.default_rng(seed)
    A, b = rng.normal(size=(30, 12)), rng.normal(size=30)
    np.testing.assert_allclose(solve_nonnegative(A.T @ A, A.T @ b), nnls(A, b)[0], atol=1e-9)


@pytest.mark.parametrize("seed", range(8))
def test_weights_are_the_best_of_all_that_sum_to_one(seed):
    rng = np.random.default_rng(seed)
    A = rng.normal(size=(9, 6))
    G, allowed = A.T @ A, np.array([1, 1, 0, 1, 1, 1], dtype=bool)
    best = find_weights(G, allowed)
    assert best.sum() == pytest.approx(1.0) and (best >= 0).all() and best[2] == 0.0
    others = rng.dirichlet(np.full(5, 0.5), 2000)
    full = np.zeros((2000, 6))
    full[:, allowed] = others
    assert best @ G @ best <= np.einsum("ni,ij,nj->n", full, G, full).min() + 1e-9


def test_joints_that_are_averages_of_vertices_are_found_again_in_unseen_people():
    fingers = make_fingers(people=8, poses=1)
    weights = make_weights(make_tube()[0][:, 0], 0.008)
    regressor = fit_joint_regressor(fingers.templates[:6], fingers.joints[:6], weights, PARENTS)
    found = np.stack([regressor @ template for template in fingers.templates[6:]])
    np.testing.assert_allclose(found, fingers.joints[6:], atol=2e-4)


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


def test_a_space_explains_all_of_what_has_few_dimensions():
    rng = np.random.default_rng(2)
    samples = rng.normal(size=(40, 3)) * [3.0, 1.0, 0.3] @ np.linalg.qr(rng.normal(size=(12, 3)))[0].T + 5.0
    space = find_space(samples)
    assert space.explained[2] == pytest.approx(1.0)
    np.testing.assert_allclose(space.components @ space.components.T, np.eye(len(space.components)), atol=1e-9)
    mean, directions, _ = find_shape_space(samples.reshape(40, 4, 3), 3)
    coefficients = np.linalg.lstsq(directions.reshape(12, 3), (samples - mean.ravel()).T, rcond=None)[0]
    np.testing.assert_allclose(coefficients.std(1, ddof=1), 1.0, atol=1e-9)


def test_templates_that_differ_by_how_they_are_turned_become_one():
    rng = np.random.default_rng(3)
    tube, _ = make_tube()
    turns = [np.linalg.qr(np.eye(3) + 0.2 * rng.normal(size=(3, 3)))[0] for _ in range(5)]
    turns = [Q * np.sign(np.diag(Q)) for Q in turns]
    templates = np.stack([tube @ Q.T + rng.normal(size=3) for Q in turns])
    aligned, joints, turned = align_rigidly(templates, templates[:, :4], np.ones(len(tube)))
    assert np.abs(aligned - aligned[0]).max() < 1e-6
    np.testing.assert_allclose(joints, aligned[:, :4], atol=1e-12)
    np.testing.assert_allclose(np.linalg.det(turned), 1.0)


def test_first_templates_are_made_of_hands_at_rest():
    fingers = make_fingers(people=2, poses=10)
    weights = weigh_by_pose(Poses(fingers.rotations, fingers.translations, np.zeros(20)), fingers.owners)
    assert weights.reshape(2, 10).sum(1) == pytest.approx([1.0, 1.0])
    assert (weights.reshape(2, 10).argmax(1) == 0).all() and weights[0] > 0.3


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
