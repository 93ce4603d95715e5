"""Joint axes of a hand worked out from its joints at rest."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tracker.model import load_t16_model
from tracker.model.hand_axes import HandChains, derive_hand_joints, find_flexion_axis
from tracker.model.joints import FINGERS
from tracker.model.t16_hand import find_hand


def flat_hand(side: str, with_metacarpals: bool = True) -> HandChains:
    """Straight fingers in the plane z = 0, the back of the hand up."""
    to_thumb = 1.0 if side == "right" else -1.0
    fingers = {}
    for number, finger in enumerate(FINGERS):
        y = to_thumb * (0.05 - 0.02 * number)
        steps = (0.02, 0.05, 0.08, 0.10) if finger == "thumb" else (0.02, 0.09, 0.13, 0.155, 0.18)
        fingers[finger] = np.array([[x, y, 0.0] for x in steps])
        if finger != "thumb" and not with_metacarpals:
            fingers[finger] = fingers[finger][1:]
    return HandChains(side, np.array([0.0, to_thumb * 0.01, 0.0]), fingers)


@pytest.mark.parametrize("side", ["right", "left"])
def test_a_straight_finger_bends_towards_the_palm_about_a_line_across_the_hand(side: str) -> None:
    chains = flat_hand(side)
    np.testing.assert_allclose(chains.dorsal, [0.0, 0.0, 1.0], atol=1e-12)
    for finger in FINGERS[1:]:
        np.testing.assert_allclose(find_flexion_axis(chains, finger), [0.0, 1.0, 0.0], atol=1e-12)


@pytest.mark.parametrize("side", ["right", "left"])
def test_the_axes_of_a_bone_are_square_to_each_other(side: str) -> None:
    joints = derive_hand_joints(flat_hand(side))
    for one in joints:
        assert np.linalg.norm(one.axis) == pytest.approx(1.0)
        for other in joints:
            if one is not other and (one.finger, one.segment) == (other.finger, other.segment):
                assert abs(one.axis @ other.axis) < 1e-9


def test_31_joints_with_every_metacarpal_and_26_without() -> None:
    assert len(derive_hand_joints(flat_hand("right"))) == 31
    assert len(derive_hand_joints(flat_hand("right", with_metacarpals=False))) == 26


def test_limits_count_from_the_rest_pose_so_that_a_bent_finger_may_still_be_straightened() -> None:
    chains = flat_hand("right")
    bent = {f: points.copy() for f, points in chains.fingers.items()}
    angle = np.radians(40.0)
    middle = bent["index"][2]
    turn = np.array([[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]])
    bent["index"][3:] = (bent["index"][3:] - middle) @ turn.T + middle
    joints = derive_hand_joints(HandChains("right", chains.wrist, bent))
    (pip,) = [joint for joint in joints if (joint.finger, joint.segment) == ("index", "middle")]
    np.testing.assert_allclose(np.degrees([pip.lower, pip.upper]), [-50.0, 72.0], atol=1e-6)


@pytest.mark.shared_data
@pytest.mark.parametrize("name", ["Model_Hand_R", "Model_Hand_L"])
def test_derived_flexion_axes_agree_with_those_that_experts_gave_another_hand(shared_data: Path, name: str) -> None:
    model = load_t16_model(shared_data / "ijcv16" / "models" / f"{name}.OFF", max_faces=None)
    skeleton = model.skeleton
    hand = find_hand(skeleton.bone_names)
    assert hand is not None and model.hand is not None
    tips = model.vertices[model.hand.joint_vertices[[4, 8, 12, 16, 20]]]
    chains = hand.chains(skeleton.joints_rest, tips)
    for finger in FINGERS:
        last = hand.fingers[finger][-1]
        (theirs,) = skeleton.dof_axes[skeleton.dof_bones == last]
        angle = np.degrees(np.arccos(-theirs @ find_flexion_axis(chains, finger)))
        assert angle < (30.0 if finger == "thumb" else 17.0), finger
