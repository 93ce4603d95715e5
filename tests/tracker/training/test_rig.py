"""A hand of a training moves as the blend model does that it becomes."""

import numpy as np
from scipy.spatial.transform import Rotation

from tests.tracker.random_blend import random_blend, random_pose
from tracker.model.skinning import keep_heaviest
from tracker.training.rig import Rig, find_features, place, turn


def test_a_hand_with_the_models_own_joints_is_the_posed_model():
    model = random_blend()
    pose, shape, translation = random_pose(model)
    rotations = Rotation.from_rotvec(pose).as_matrix()
    rig = Rig(model.parents, keep_heaviest(model.skinning_weights), model.pose_directions)
    template = model.shaped(shape)
    hand = place(rig, template, model.joints_of(template), rotations, translation)
    expected = model.pose_at(pose, shape, translation)
    np.testing.assert_allclose(hand.joints, expected.joints, atol=1e-14)
    assert np.abs(hand.vertices - expected.vertices).max() < 1e-12
    bulges = np.einsum("vxn,n->vx", model.pose_directions, find_features(rotations[None])[0])
    np.testing.assert_allclose(hand.rest - template, bulges, atol=1e-14)


def test_a_step_turns_from_the_left_in_the_order_of_the_blend_model():
    model = random_blend()
    pose, shape, translation = random_pose(model)
    step = 0.3 * np.random.default_rng(2).normal(size=3 + 3 * model.num_bones)
    rotations, moved = turn(Rotation.from_rotvec(pose).as_matrix(), translation, step)
    expected, _, place_after = model.retract(pose, shape, translation, step)
    np.testing.assert_allclose(rotations, Rotation.from_rotvec(expected).as_matrix(), atol=1e-12)
    np.testing.assert_allclose(moved, place_after)
