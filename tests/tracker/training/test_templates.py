"""Personal templates: registrations unposed and averaged give each person's own rest shape."""

import numpy as np
import pytest

from tests.tracker.training.fingers import PARENTS, make_fingers
from tracker.model.skinning import keep_heaviest
from tracker.training.pose_fit import Poses
from tracker.training.rig import Rig, find_features
from tracker.training.templates import fit_templates, unpose, weigh_by_pose


@pytest.fixture(scope="module")
def fingers():
    return make_fingers(people=3, poses=8)


@pytest.fixture(scope="module")
def poses(fingers):
    return Poses(fingers.rotations, fingers.translations, np.zeros(24))


@pytest.fixture(scope="module")
def rig(fingers):
    return Rig(PARENTS, keep_heaviest(fingers.weights), fingers.directions)


def test_true_poses_give_the_true_templates_whatever_the_weights(fingers, poses, rig):
    for weights in (np.ones(24), weigh_by_pose(poses, fingers.owners)):
        found = fit_templates(poses, fingers.targets, fingers.owners, weights, fingers.joints, rig)
        assert found == pytest.approx(fingers.templates, abs=1e-9)


def test_a_registration_without_weight_counts_for_nothing(fingers, poses, rig):
    targets, weights = fingers.targets.copy(), np.ones(24)
    targets[5] += 0.1
    weights[5] = 0.0
    found = fit_templates(poses, targets, fingers.owners, weights, fingers.joints, rig)
    assert found == pytest.approx(fingers.templates, abs=1e-9)


def test_unposed_registrations_are_template_and_blend_shapes_together(fingers, poses, rig):
    rest = unpose(poses, fingers.targets, fingers.owners, fingers.joints, rig)
    expected = fingers.templates[fingers.owners] + np.einsum(
        "vin,mn->mvi", fingers.directions, find_features(poses.rotations)
    )
    assert rest == pytest.approx(expected, abs=1e-9)


def test_a_rotation_of_the_whole_hand_is_no_pose(fingers, poses):
    turned = poses.rotations.copy()
    turned[:, 0] = np.eye(3)
    same = weigh_by_pose(Poses(turned, poses.translations, poses.errors), fingers.owners)
    assert same == pytest.approx(weigh_by_pose(poses, fingers.owners))


def test_a_hand_at_rest_counts_no_more_than_one_half_a_radian_away():
    rotations = np.tile(np.eye(3), (2, 4, 1, 1))
    c, s = np.cos(0.3), np.sin(0.3)
    rotations[1, 1] = [[c, -s, 0], [s, c, 0], [0, 0, 1]]
    weights = weigh_by_pose(Poses(rotations, np.zeros((2, 3)), np.zeros(2)), np.zeros(2, dtype=np.int64))
    assert weights == pytest.approx([0.5, 0.5])


def test_first_templates_are_made_of_hands_at_rest():
    fingers = make_fingers(people=2, poses=10)
    weights = weigh_by_pose(Poses(fingers.rotations, fingers.translations, np.zeros(20)), fingers.owners)
    assert weights.reshape(2, 10).sum(1) == pytest.approx([1.0, 1.0])
    assert (weights.reshape(2, 10).argmax(1) == 0).all() and weights[0] > 0.3
