"""What is explained is left out of a frame, and so are forearms; everything else stays."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.grips import ball
from tests.tracker.scenes import CAMERA, move_pose, palm_to_camera, photograph
from tracker.capture.frame import Frame
from tracker.geometry import se3
from tracker.model.default_hand import default_hand
from tracker.model.scene import Scene
from tracker.search.leave_out import (
    CORE,
    EXPLAINED,
    LENGTH,
    OPENING,
    RADIUS,
    is_in_forearm,
    leave_out,
    leave_out_forearms,
)

HAND = default_hand("right")
SCENE = Scene((HAND, ball(0.03)))
POSE = np.r_[palm_to_camera(HAND, (-0.04, 0.0, 0.45)), 0.1, 0.0, 0.4, 0.0, 0.0, 0.0]
JOINTS = SCENE.pose_at(POSE).landmarks(0)
WRIST, BACK = JOINTS[0], (JOINTS[0] - JOINTS[9]) / np.linalg.norm(JOINTS[0] - JOINTS[9])


@pytest.fixture
def frame() -> Frame:
    """Hand and ball before a wall."""
    drawn = photograph(SCENE, POSE)
    assert drawn.depth is not None
    return replace(drawn, depth=np.where(drawn.depth > 0, drawn.depth, np.float32(0.8)))


def depth_of(frame: Frame) -> np.ndarray:
    assert frame.depth is not None
    return frame.depth


def test_each_model_takes_its_own_pixels_out_and_leaves_those_of_the_others_and_the_wall(frame):
    hand = frame.is_hand
    thing = (depth_of(frame) < 0.6) & ~hand
    for models, gone in (([0], hand), ([1], thing), ([0, 1], hand | thing), ([1, 0], hand | thing)):
        left = leave_out(frame, CAMERA, SCENE, POSE, models)
        np.testing.assert_array_equal(depth_of(left) == 0, gone)
        np.testing.assert_array_equal(depth_of(left)[~gone], depth_of(frame)[~gone])
    assert np.all(depth_of(frame) > 0), "the frame that was given stays"


def test_leaving_out_twice_is_leaving_out_once(frame):
    once = leave_out(frame, CAMERA, SCENE, POSE, [0])
    np.testing.assert_array_equal(depth_of(leave_out(once, CAMERA, SCENE, POSE, [0])), depth_of(once))


@pytest.mark.parametrize(("off", "is_left"), [(0.9, False), (-0.9, False), (1.1, True), (-1.1, True)])
def test_a_pixel_is_explained_by_what_is_drawn_so_near_to_it_and_no_farther(frame, off, is_left):
    moved = replace(frame, depth=depth_of(frame) + np.float32(off * EXPLAINED))
    left = depth_of(leave_out(moved, CAMERA, SCENE, POSE, [0]))
    assert np.all((left[frame.is_hand] > 0) == is_left)


def test_without_models_or_depth_the_frame_is_returned_as_it_is(frame):
    blind = replace(frame, depth=None)
    assert leave_out(frame, CAMERA, SCENE, POSE, []) is frame
    assert leave_out(blind, CAMERA, SCENE, POSE, [0]) is blind
    assert leave_out_forearms(frame, CAMERA, []) is frame
    assert leave_out_forearms(blind, CAMERA, [JOINTS]) is blind


def test_a_sleeve_behind_the_wrist_goes_and_hand_ball_and_wall_stay(frame):
    sleeved = depth_of(frame).copy()
    column, row = np.rint(CAMERA.project(WRIST[None]))[0].astype(int)
    sleeve = np.s_[row + 5 :, column - 25 : column + 26]
    sleeved[sleeve] = 0.45
    left = depth_of(leave_out_forearms(replace(frame, depth=sleeved), CAMERA, [JOINTS]))
    assert np.all(left[sleeve] == 0)
    before = np.zeros_like(frame.is_hand)
    before[: row - 1] = True
    np.testing.assert_array_equal(left[before], sleeved[before])
    assert np.all(left[sleeved == np.float32(0.8)] > 0)


def test_hands_and_camera_moved_together_leave_out_the_same(frame):
    T = se3.exp(np.array([0.2, -1.0, 0.4, 1.0, 0.3, -2.0]))
    there, moved = replace(CAMERA, T_world_camera=T), move_pose(SCENE, T, POSE)
    low = replace(frame, depth=np.where(depth_of(frame) == np.float32(0.8), np.float32(0.46), depth_of(frame)))
    arms = [leave_out_forearms(low, CAMERA, [JOINTS]), leave_out_forearms(low, there, [se3.transform(T, JOINTS)])]
    models = [leave_out(frame, CAMERA, SCENE, POSE, [0]), leave_out(frame, there, SCENE, moved, [0])]
    for here, other in (arms, models):
        assert np.count_nonzero((depth_of(here) == 0) != (depth_of(other) == 0)) <= 10  # px on the rim
    assert np.count_nonzero(depth_of(arms[0]) == 0) > 500


def test_two_forearms_are_left_out_in_either_order(frame):
    other = JOINTS + np.array([0.15, -0.02, 0.05])
    one, two = (leave_out_forearms(frame, CAMERA, hands) for hands in ([JOINTS, other], [other, JOINTS]))
    np.testing.assert_array_equal(depth_of(one), depth_of(two))


@pytest.mark.parametrize("behind", [0.001, 0.1, 0.39])
def test_the_middle_of_a_thing_is_in_the_forearm_up_to_a_share_of_a_cone_that_opens(behind):
    aside = np.cross(BACK, [0.0, 0.0, 1.0])
    aside /= np.linalg.norm(aside)
    limit = CORE * (RADIUS + OPENING * behind)
    for share, inside in ((0.0, True), (0.98, True), (1.02, False)):
        assert is_in_forearm(WRIST + behind * BACK + share * limit * aside, [JOINTS]) is inside
        assert is_in_forearm(WRIST + behind * BACK - share * limit * aside, [JOINTS + 5.0, JOINTS]) is inside


def test_nothing_before_the_wrist_beyond_an_arms_length_or_without_a_hand_is_in_a_forearm():
    for behind in (-0.001, -0.1, LENGTH + 0.001):
        assert not is_in_forearm(WRIST + behind * BACK, [JOINTS])
    assert not is_in_forearm(WRIST + 0.1 * BACK, [])
    nowhere = np.repeat(WRIST[None], 21, axis=0)  # joints that all are one point have no direction
    assert not is_in_forearm(WRIST + 0.1 * BACK, [nowhere])
