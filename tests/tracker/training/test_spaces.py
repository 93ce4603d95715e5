"""Principal components of shapes and poses."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from tests.tracker.training.fingers import make_tube
from tracker.training.spaces import Space, align_rigidly, compute_rotation_vectors, find_shape_space, find_space


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


@settings(max_examples=40)
@given(st.integers(2, 8), st.integers(1, 8), st.integers(0, 1000))
def test_all_components_together_give_the_samples_back(count, size, seed):
    samples = np.random.default_rng(seed).normal(size=(count, size))
    space = find_space(samples)
    assert len(space.components) == min(count - 1, size)
    assert np.all(np.diff(space.variances) <= 1e-12)
    away = samples - space.mean
    np.testing.assert_allclose(away @ space.components.T @ space.components, away, atol=1e-9)
    np.testing.assert_allclose((away @ space.components.T).var(axis=0, ddof=1), space.variances, atol=1e-9)


def test_the_sign_of_a_component_does_not_depend_on_the_samples_order_and_its_largest_element_is_positive():
    samples = np.random.default_rng(4).normal(size=(9, 5)) * [5.0, 4.0, 3.0, 2.0, 1.0]
    space = find_space(samples)
    largest = np.abs(space.components).argmax(axis=1)
    assert (space.components[np.arange(5), largest] > 0.0).all()
    for other in (samples[::-1], 2.0 * samples.mean(0) - samples):
        np.testing.assert_allclose(find_space(other).components, space.components, atol=1e-9)


def test_one_sample_has_no_components_and_is_its_own_mean():
    space = find_space(np.array([[1.0, 2.0, 3.0]]))
    assert space.components.shape == (0, 3) and space.variances.shape == (0,)
    np.testing.assert_array_equal(space.mean, [1.0, 2.0, 3.0])


def test_shares_explained_add_up_to_one_and_what_does_not_vary_is_explained():
    shares = Space(np.zeros(2), np.eye(2), np.array([3.0, 1.0])).explained
    np.testing.assert_allclose(shares, [0.75, 1.0])
    np.testing.assert_array_equal(find_space(np.ones((4, 3))).explained, np.ones(3))


def test_a_shape_space_has_no_more_directions_than_people_can_tell():
    templates = np.random.default_rng(5).normal(size=(4, 6, 3))
    mean, directions, space = find_shape_space(templates, 10)
    np.testing.assert_allclose(mean, templates.mean(axis=0))
    assert directions.shape == (6, 3, 3) and len(space.components) == 3
    np.testing.assert_allclose(np.linalg.norm(directions, axis=(0, 1)), np.sqrt(space.variances))
    fewer = find_shape_space(templates, 2)[1]
    np.testing.assert_array_equal(fewer, directions[:, :, :2])


def test_templates_are_laid_on_their_mean_as_rigid_bodies_and_those_given_stay():
    rng = np.random.default_rng(6)
    templates, joints = rng.normal(size=(3, 20, 3)), rng.normal(size=(3, 4, 3))
    before = templates.copy()
    aligned, placed, turned = align_rigidly(templates, joints, rng.uniform(size=20))
    np.testing.assert_array_equal(templates, before)
    for s in range(3):
        offset = aligned[s] - templates[s] @ turned[s].T
        np.testing.assert_allclose(offset, np.tile(offset[0], (20, 1)), atol=1e-9)
        np.testing.assert_allclose(placed[s], joints[s] @ turned[s].T + offset[0], atol=1e-9)


def test_only_the_anchor_says_how_templates_are_laid():
    rng = np.random.default_rng(7)
    palm, anchor = rng.normal(size=(12, 3)), np.r_[np.ones(12), np.zeros(5)]
    turns = Rotation.from_rotvec(0.3 * rng.normal(size=(4, 3))).as_matrix()
    templates = np.stack([np.concatenate([palm, rng.normal(size=(5, 3))]) @ R.T for R in turns])
    aligned, _, _ = align_rigidly(templates, templates[:, :1], anchor, rounds=8)
    np.testing.assert_allclose(aligned[:, :12], np.tile(aligned[0, :12], (4, 1, 1)), atol=1e-6)
    assert np.ptp(aligned[:, 12:], axis=0).min() > 1e-3


def test_rotation_vectors_say_the_same_turn_up_to_half_a_turn():
    vectors = np.array([[0.0, 0.0, 0.0], [0.2, -0.3, 0.1], [0.0, np.pi, 0.0], [3.0, 0.0, 0.0]])
    found = compute_rotation_vectors(Rotation.from_rotvec(vectors).as_matrix())
    np.testing.assert_allclose(np.abs(found), np.abs(vectors), atol=1e-7)
    longer = compute_rotation_vectors(Rotation.from_rotvec([[4.0, 0.0, 0.0]]).as_matrix())
    np.testing.assert_allclose(longer, [[4.0 - 2.0 * np.pi, 0.0, 0.0]], atol=1e-9)
