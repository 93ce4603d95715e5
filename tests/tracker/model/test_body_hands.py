"""Where the hands are in a body, and how their poses are written into its."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tracker.random_blend import random_blend
from tracker.model.body_hands import NUM_BODY_JOINTS, NUM_FINGER_JOINTS, R_BODY_HAND, body_hand, body_pose
from tracker.model.body_model import body_model
from tracker.model.mano_files import SMPLH_JOINTS
from tracker.model.trained_hand import trained_hand

BODY = body_model()
SIDES = ("left", "right")


@pytest.mark.parametrize("side", SIDES)
def test_wrist_elbow_and_fingers_are_the_joints_of_those_names(side: str) -> None:
    hand = body_hand(BODY, side)
    assert SMPLH_JOINTS[hand.wrist] == f"{side}_wrist" and SMPLH_JOINTS[hand.elbow] == f"{side}_elbow"
    assert BODY.parents[hand.wrist] == hand.elbow
    assert len(hand.fingers) == NUM_FINGER_JOINTS == 15
    assert all(SMPLH_JOINTS[joint].startswith(side) for joint in hand.fingers)
    assert set(BODY.parents[hand.fingers]) <= {hand.wrist, *hand.fingers}


def test_the_two_hands_share_out_all_joints_behind_the_body_s() -> None:
    left, right = (body_hand(BODY, side) for side in SIDES)
    np.testing.assert_array_equal(np.r_[left.fingers, right.fingers], np.arange(NUM_BODY_JOINTS, len(SMPLH_JOINTS)))
    assert not set(left.vertices) & set(right.vertices)


@pytest.mark.parametrize("side", SIDES)
def test_the_vertices_are_those_of_the_trained_hand_turned_into_the_body_s_axes(side: str) -> None:
    hand, model = body_hand(BODY, side), trained_hand(side)
    assert len(hand.vertices) == len(model.template)
    own, alone = BODY.template[hand.vertices], model.template @ hand.R_body_hand.T
    own, alone = own - own.mean(axis=0), alone - alone.mean(axis=0)
    assert np.linalg.norm(own - alone, axis=1).mean() < 0.15 * np.linalg.norm(alone, axis=1).mean()


@pytest.mark.parametrize("side", SIDES)
def test_the_turn_between_the_axes_is_a_rotation_and_fingers_point_outwards(side: str) -> None:
    R = R_BODY_HAND[side]
    np.testing.assert_array_equal(R @ R.T, np.eye(3))
    assert np.linalg.det(R) == 1.0
    hand, joints = body_hand(BODY, side), BODY.joints_of(BODY.template)
    along = joints[hand.fingers].mean(axis=0) - joints[hand.wrist]
    assert (along * hand.outwards)[0] > 0.9 * np.linalg.norm(along)
    np.testing.assert_array_equal(R[:, 0] * hand.outwards, [1.0, 0.0, 0.0])


@pytest.mark.parametrize("side", SIDES)
def test_a_hand_s_columns_are_its_fingers_numbers_and_its_components_the_body_s_that_move_them(side: str) -> None:
    hand = body_hand(BODY, side)
    numbers = np.repeat(np.arange(1, len(SMPLH_JOINTS)), 3)
    np.testing.assert_array_equal(numbers[hand.columns], np.repeat(hand.fingers, 3))
    components = hand.components_of(BODY)
    assert components.shape[1] == 45 and 0 < len(components) < len(BODY.pose_components)
    assert (np.abs(components).max(axis=1) > 0.0).all()
    rest = np.delete(BODY.pose_components, np.arange(153)[hand.columns], axis=1)
    moves_others = rest.any(axis=1)[BODY.pose_components[:, hand.columns].any(axis=1)]
    assert not moves_others.any()


def test_a_body_is_posed_by_its_parts_in_smplh_s_order() -> None:
    rng = np.random.default_rng(0)
    root, body, hands = rng.normal(size=3), rng.normal(size=(21, 3)), rng.normal(size=(2, 45))
    pose = body_pose(BODY, root, body, dict(zip(SIDES, hands, strict=True)), is_flat_mean=True)
    np.testing.assert_array_equal(pose.ravel(), np.r_[root, body.ravel(), hands.ravel()])
    from_mean = body_pose(BODY, root, body, dict(zip(SIDES, hands, strict=True)))
    np.testing.assert_allclose((from_mean - pose)[1:].ravel(), np.r_[np.zeros(63), BODY.pose_mean[63:]], atol=1e-15)


@pytest.mark.parametrize("count", [0, 1, 6, 44])
def test_fewer_than_45_numbers_are_coefficients_of_the_hand_s_own_components(count: int) -> None:
    hand = body_hand(BODY, "right")
    components = hand.components_of(BODY)
    assert count <= len(components)
    numbers = np.random.default_rng(1).normal(size=count)
    pose = body_pose(BODY, np.zeros(3), np.zeros((21, 3)), {"right": numbers}, is_flat_mean=True)
    np.testing.assert_allclose(pose[hand.fingers].ravel(), numbers @ components[:count], atol=1e-12)
    assert not pose[: hand.fingers[0]].any()


def test_a_hand_is_no_body_and_a_body_has_two_sides() -> None:
    for model, side in ((random_blend(), "right"), (BODY, "both")):
        with pytest.raises(AssertionError):
            body_hand(model, side)
    with pytest.raises(AssertionError):
        body_pose(BODY, np.zeros(3), np.zeros((21, 3)), {"left": np.zeros(46)})
