"""Joints as weighted averages of few vertices, from people whose joints are known."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tests.tracker.training.fingers import PARENTS, Fingers, make_fingers, make_tube, make_weights
from tracker.training.regressor import SMALLEST, fit_joint_regressor

WEIGHTS = make_weights(make_tube()[0][:, 0], 0.008)


@pytest.fixture(scope="module")
def fingers() -> Fingers:
    return make_fingers(people=6, poses=1)


def test_joints_that_are_averages_of_vertices_are_found_again_in_unseen_people():
    fingers = make_fingers(people=8, poses=1)
    weights = make_weights(make_tube()[0][:, 0], 0.008)
    regressor = fit_joint_regressor(fingers.templates[:6], fingers.joints[:6], weights, PARENTS)
    found = np.stack([regressor @ template for template in fingers.templates[6:]])
    np.testing.assert_allclose(found, fingers.joints[6:], atol=2e-4)


def test_rows_are_averages_of_few_vertices_and_none_counts_next_to_nothing(fingers):
    rows = fit_joint_regressor(fingers.templates, fingers.joints, WEIGHTS, PARENTS).toarray()
    assert rows.shape == (4, len(make_tube()[0]))
    np.testing.assert_allclose(rows.sum(axis=1), 1.0)
    assert rows[rows != 0.0].min() >= SMALLEST
    assert (rows != 0.0).sum(axis=1).max() <= 150


def test_a_joint_is_averaged_from_vertices_of_its_bone_and_of_the_bone_before(fingers):
    rows = fit_joint_regressor(fingers.templates, fingers.joints, WEIGHTS, PARENTS).toarray()
    for bone, parent in enumerate(PARENTS):
        follow = WEIGHTS[:, bone] + (WEIGHTS[:, parent] if parent >= 0 else 0.0)
        assert follow[rows[bone] > 0.0].min() > 0.1


def test_a_bone_that_hardly_a_vertex_follows_takes_the_nearest_ones(fingers):
    weights = WEIGHTS.copy()
    weights[:, 0] += weights[:, 3] + weights[:, 2]
    weights[:, 2:] = 0.0
    rows = fit_joint_regressor(fingers.templates, fingers.joints, weights, PARENTS).toarray()
    nearest = np.linalg.norm(fingers.templates - fingers.joints[:, None, 3], axis=2).mean(axis=0)
    assert set(np.flatnonzero(rows[3])) <= set(np.argsort(nearest)[:40])
    np.testing.assert_allclose(np.einsum("v,svi->si", rows[3], fingers.templates), fingers.joints[:, 3], atol=2e-4)


def test_people_who_are_turned_and_moved_have_the_same_regressor(fingers):
    plain = fit_joint_regressor(fingers.templates, fingers.joints, WEIGHTS, PARENTS).toarray()
    turns = Rotation.random(6, rng=np.random.default_rng(1)).as_matrix()
    shifts = np.random.default_rng(2).normal(size=(6, 1, 3))
    templates, joints = (
        np.einsum("sij,svj->svi", turns, each) + shifts for each in (fingers.templates, fingers.joints)
    )
    moved = fit_joint_regressor(templates, joints, WEIGHTS, PARENTS).toarray()
    np.testing.assert_allclose(moved, plain, atol=1e-6)
