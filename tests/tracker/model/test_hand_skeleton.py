"""Bones of a hand from its joints: a wrist, and every finger's chain."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tracker.model.test_hand_axes import flat_hand
from tracker.model.hand_axes import derive_hand_joints, find_flexion_axis
from tracker.model.hand_skeleton import build_hand_skeleton, hand_bone_names
from tracker.model.joints import FINGERS

every_hand = pytest.mark.parametrize("side", ["right", "left"])


def test_names_go_from_the_wrist_by_finger_from_the_palm_out() -> None:
    names = hand_bone_names(flat_hand("right"))
    assert names[:5] == ("wrist", "thumb_metacarpal", "thumb_proximal", "thumb_distal", "index_metacarpal")
    assert len(names) == len(set(names)) == 20
    without = hand_bone_names(flat_hand("right", with_metacarpals=False))
    assert set(names) - set(without) == {f"{finger}_metacarpal" for finger in FINGERS[1:]}


@pytest.mark.parametrize("with_metacarpals", [True, False])
def test_a_finger_hangs_on_the_wrist_and_each_bone_on_the_one_before(with_metacarpals: bool) -> None:
    chains = flat_hand("right", with_metacarpals)
    skeleton = build_hand_skeleton(chains, derive_hand_joints(chains))
    assert skeleton.bone_names == hand_bone_names(chains)
    for bone, name in enumerate(skeleton.bone_names[1:], 1):
        finger, segment = name.split("_")
        number = chains.segments(finger).index(segment)
        before = "wrist" if number == 0 else f"{finger}_{chains.segments(finger)[number - 1]}"
        assert skeleton.bone_names[skeleton.parents[bone]] == before
        np.testing.assert_array_equal(skeleton.joints_rest[bone], chains.fingers[finger][number])
    assert skeleton.parents[0] == -1
    np.testing.assert_array_equal(skeleton.joints_rest[0], chains.wrist)


@every_hand
def test_frames_run_along_their_bones_with_z_out_of_the_back(side: str) -> None:
    chains = flat_hand(side)
    skeleton = build_hand_skeleton(chains, derive_hand_joints(chains))
    R = skeleton.Ts_model_bone[:, :3, :3]
    np.testing.assert_allclose(R @ R.transpose(0, 2, 1), np.tile(np.eye(3), (20, 1, 1)), atol=1e-12)
    np.testing.assert_allclose(np.linalg.det(R), 1.0)
    np.testing.assert_allclose(R[0, :, 0], chains.forward, atol=1e-12)
    for bone, name in enumerate(skeleton.bone_names):
        if name.startswith(("wrist", *FINGERS[1:])):
            np.testing.assert_allclose(R[bone, :, 2], chains.dorsal, atol=1e-12)
    for finger in FINGERS:
        steps = np.diff(chains.fingers[finger], axis=0)
        first = skeleton.bone_names.index(f"{finger}_{chains.segments(finger)[0]}")
        for number, along in enumerate(steps):
            np.testing.assert_allclose(R[first + number, :, 0], along / np.linalg.norm(along), atol=1e-12)


@every_hand
def test_the_back_of_the_thumb_is_square_to_the_axis_that_it_bends_about(side: str) -> None:
    chains = flat_hand(side)
    skeleton = build_hand_skeleton(chains, derive_hand_joints(chains))
    bone = skeleton.bone_names.index("thumb_distal")
    axis = find_flexion_axis(chains, "thumb")
    np.testing.assert_allclose(skeleton.Ts_model_bone[bone, :3, 1], axis, atol=1e-9)
    assert abs(skeleton.Ts_model_bone[bone, :3, 2] @ chains.dorsal) < 0.9, "it is rolled against the fingers"


def test_revolute_joints_turn_the_bones_they_name_with_their_axes_and_limits_in_order() -> None:
    chains = flat_hand("left")
    joints = derive_hand_joints(chains)
    skeleton = build_hand_skeleton(chains, joints)
    assert [skeleton.bone_names[bone] for bone in skeleton.dof_bones] == [f"{j.finger}_{j.segment}" for j in joints]
    np.testing.assert_array_equal(skeleton.dof_axes, [joint.axis for joint in joints])
    np.testing.assert_array_equal(skeleton.lower, [joint.lower for joint in joints])
    np.testing.assert_array_equal(skeleton.upper, [joint.upper for joint in joints])
    assert (skeleton.lower < 0.0).all() and (skeleton.upper > 0.0).all(), "the rest pose is within every limit"
