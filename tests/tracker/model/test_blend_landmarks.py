"""Landmarks of a learnt hand lie where bones do."""

import numpy as np
import pytest

from tests.tracker.toys import tube
from tracker.model.blend_articulated import articulated_of
from tracker.model.blend_landmarks import FINGER_DEPTH, find_landmark_offsets
from tracker.model.hand_axes import HandChains
from tracker.model.joints import FINGERS, HAND_JOINTS
from tracker.model.trained_hand import trained_hand


def test_in_a_round_finger_the_landmark_is_a_third_of_its_thickness_beneath_the_back():
    finger = tube(bones=3, rings=40, sides=64, radius=0.008, length=0.09)
    axis = np.array([[x, 0.0, 0.003] for x in (0.0, 0.03, 0.06, 0.09)])  # the joints lie 3 mm above the middle
    fingers = {name: axis + np.array([0.0, 0.02 * (2 - n), 0.0]) for n, name in enumerate(FINGERS)}
    fingers["thumb"] = fingers["thumb"] + np.array([0.0, 0.0, 1.0])
    chains = HandChains("right", np.array([-0.08, 0.0, 0.003]), fingers)
    offsets = find_landmark_offsets(finger.vertices, finger.faces, chains)
    pip = HAND_JOINTS.index("middle_pip")
    np.testing.assert_allclose(offsets[pip], [0.0, 0.0, 0.008 - 0.016 * FINGER_DEPTH - 0.003], atol=1e-4)
    assert not offsets[0].any() and not offsets[HAND_JOINTS.index("thumb_cmc")].any(), "no skin there: they stay"


@pytest.mark.parametrize("side", ["right", "left"])
def test_those_of_the_trained_hand_are_deeper_than_its_joints_and_mirror_images(side):
    hand = articulated_of(trained_hand(side)).hand
    other = articulated_of(trained_hand("left" if side == "right" else "right")).hand
    assert hand is not None and other is not None
    moved = {name for name, offset in zip(HAND_JOINTS, hand.joint_offsets, strict=True) if offset.any()}
    assert moved == {"thumb_cmc", "thumb_ip", *(f"{f}_{j}" for f in FINGERS[1:] for j in ("pip", "dip"))}
    assert -0.008 < hand.joint_offsets[HAND_JOINTS.index("thumb_cmc"), 2] < -0.003
    np.testing.assert_allclose(hand.joint_offsets * [1.0, -1.0, 1.0], other.joint_offsets, atol=1e-9)
