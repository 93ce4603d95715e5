"""The simple motions do what their names say, with any hand, and smoothly."""

from __future__ import annotations

import numpy as np
import pytest

from tracker.model.default_hand import default_hand
from tracker.model.joints import HAND_JOINTS
from tracker.synthesis.motion import DISTANCE, MOTIONS, perform
from tracker.synthesis.performance import render_moment

FINGERTIPS = [HAND_JOINTS.index(f"{finger}_tip") for finger in ("index", "middle", "ring", "little")]


def joints(side: str, motion: str, count: int = 61) -> np.ndarray:
    """(T, 21, 3) world, m."""
    performance = perform({side: default_hand(side)}, motion, count)
    actor = performance.actors[0]
    return np.array([actor.joints(moment, actor.vertices(moment)) for moment in range(count)])


@pytest.mark.parametrize("side", ["right", "left"])
@pytest.mark.parametrize("motion", list(MOTIONS))
def test_every_motion_is_smooth_and_stays_in_view(side, motion):
    moved = joints(side, motion)
    speed = np.linalg.norm(np.diff(moved, axis=0), axis=2)
    assert speed.max() < 0.03, "no joint jumps by more than 30 mm a frame"
    assert speed.max(axis=1).min() > 1e-5, "something moves all the time"
    performance = perform({side: default_hand(side)}, motion, 61)
    for moment in (0, 20, 40, 60):
        pixels = render_moment(performance, moment).pixels
        assert np.all((pixels > 20) & (pixels < [620, 460]))


@pytest.mark.parametrize("side", ["right", "left"])
def test_a_hand_opens_and_closes_with_its_palm_to_the_camera(side):
    moved = joints(side, "open-close")
    reach = np.linalg.norm(moved[:, FINGERTIPS] - moved[:, :1], axis=2).mean(axis=1)
    assert reach[30] < 0.65 * reach[0], "after a second it is closed"
    assert reach[60] == pytest.approx(reach[0], rel=0.01), "after two it is open again"
    opened, half_closed = moved[0], moved[15]
    assert opened[0, 1] > opened[9, 1] > opened[12, 1], "fingers point up in the image"
    assert abs(opened[9, 2] - DISTANCE) < 0.01
    assert np.all(half_closed[FINGERTIPS, 2] < half_closed[0, 2]), "fingers close towards the camera"


def test_the_thumb_of_a_right_palm_is_on_the_right_of_the_image_and_of_a_left_one_on_the_left():
    for side, sign in (("right", 1.0), ("left", -1.0)):
        still = joints(side, "wave", 1)[0]
        thumb, little = HAND_JOINTS.index("thumb_tip"), HAND_JOINTS.index("little_tip")
        assert sign * (still[thumb, 0] - still[little, 0]) > 0.05


def test_two_hands_stand_apart():
    performance = perform({side: default_hand(side) for side in ("right", "left")}, "open-close", 3)
    moment = render_moment(performance, 0)
    assert performance.joint_names[0] == "right/wrist"
    assert performance.joint_names[21] == "left/wrist"
    assert moment.joints[:21, 0].max() < moment.joints[21:, 0].min()
