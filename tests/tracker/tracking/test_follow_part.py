"""A part of a scene is followed to the next frame; what is not of the part stays where it was."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.grips import ball
from tests.tracker.scenes import CAMERA, move_pose, palm_to_camera, photograph
from tracker.capture.frame import Frame
from tracker.fitting.attempt import UNSETTLED
from tracker.fitting.finger_search import curl_fingers, list_finger_angles
from tracker.fitting.objective import Objective
from tracker.fitting.options import TrackOptions
from tracker.fitting.setup import TrackSetup
from tracker.fitting.sighting import Sightings
from tracker.geometry import se3
from tracker.model.default_hand import default_hand
from tracker.search.part import Part
from tracker.search.tools import Tools
from tracker.tracking.follow_part import FINGER_REST, Followed, follow_part
from tracker.tracking.patience import Patience
from tracker.tracking.state import TrackState

RIGHT, LEFT = default_hand("right"), default_hand("left")
OPTIONS = TrackOptions(calibrate=False, iterations=8)
TOOLS = Tools(Objective(), None, None)
BOTH = TrackSetup(("right", "left"), (RIGHT, LEFT), "cam0", OPTIONS)
POSE = np.r_[palm_to_camera(RIGHT, (-0.09, 0.0, 0.45), 0.1), palm_to_camera(LEFT, (0.09, 0.0, 0.45), 0.3)]
STEP = se3.exp(np.array([0.004, -0.003, 0.005, 0.02, 0.03, -0.02]))
NEXT = move_pose(BOTH.scene, STEP, POSE)
"""Two centimetres farther: a fit comes there, or a second try."""


def follow(frame: Frame, setup: TrackSetup = BOTH, lost=(), pose: np.ndarray = POSE, **state) -> Followed:
    sightings = Sightings(frame, CAMERA, {}, is_looked_at=False)
    return follow_part(sightings, Part.without(setup, lost), TOOLS, TrackState(5, pose, pose, **state))


def joint_errors(setup: TrackSetup, pose: np.ndarray, truth: np.ndarray) -> list[float]:
    """Mean distance of each hand's joints, m."""
    one, other = setup.scene.pose_at(pose), setup.scene.pose_at(truth)
    return [float(np.linalg.norm(one.landmarks(hand) - other.landmarks(hand), axis=1).mean()) for hand in setup.hands]


def test_both_hands_are_followed_and_there_is_nothing_to_try_again():
    followed = follow(photograph(BOTH.scene, NEXT))
    assert followed.attempt is not None and not followed.attempt.lost
    assert max(joint_errors(BOTH, followed.attempt.pose, NEXT)) < 1.5e-3
    assert followed.second_try == Patience() and followed.tips == Patience()


def test_the_order_of_hands_does_not_matter():
    swapped = replace(BOTH, names=("left", "right"), models=(LEFT, RIGHT))
    split = RIGHT.num_dofs
    frame = photograph(BOTH.scene, NEXT)
    one, other = follow(frame), follow(frame, swapped, pose=np.r_[POSE[split:], POSE[:split]])
    assert one.attempt is not None and other.attempt is not None
    back = np.r_[other.attempt.pose[LEFT.num_dofs :], other.attempt.pose[: LEFT.num_dofs]]
    assert max(joint_errors(BOTH, one.attempt.pose, back)) < 5e-4
    assert one.attempt.worth == pytest.approx(other.attempt.worth, abs=1e-3)


@pytest.mark.parametrize("lost", [0, 1])
def test_a_hand_that_is_left_out_stays_where_it_was_to_the_last_bit_and_is_not_judged(lost):
    there, near = Part.without(BOTH, (lost,)), move_pose(BOTH.scene, se3.exp(0.25 * se3.log(STEP)), POSE)
    followed = follow(photograph(there.setup.scene, there.take(near)), lost=(lost,))
    assert followed.attempt is not None
    where = BOTH.scene.pose_slices[lost]
    np.testing.assert_array_equal(followed.attempt.pose[where], POSE[where])
    assert list(followed.attempt.qualities) == [1 - lost]
    assert joint_errors(BOTH, followed.attempt.pose, near)[1 - lost] < 1.5e-3


def test_of_nobody_and_of_what_is_out_of_sight_there_is_no_attempt_and_waiting_goes_on():
    waiting = {"second_try": Patience(3, 4), "tips": Patience(1, 2)}
    frame = photograph(BOTH.scene, NEXT)
    empty = replace(frame, depth=np.zeros((240, 320), np.float32))
    away = move_pose(BOTH.scene, se3.exp(np.array([4.0, 0, 0, 0, 0, 0])), POSE)
    for followed in (
        follow(frame, lost=(0, 1), **waiting),
        follow(empty, **waiting),
        follow(frame, pose=away, **waiting),
    ):
        assert followed.attempt is None
        assert (followed.second_try, followed.tips) == (Patience(2, 4), Patience(0, 2))


def test_an_object_alone_is_followed_though_no_pixel_is_of_a_hand():
    setup = TrackSetup(("ball", "right"), (ball(0.03), RIGHT), "cam0", OPTIONS)
    pose = np.r_[0.02, 0.0, 0.45, 0.0, 0.0, 0.0, POSE[: RIGHT.num_dofs]]
    moved = pose + np.r_[0.005, -0.004, 0.006, np.zeros(len(pose) - 3)]
    alone = TrackSetup(("ball",), (ball(0.03),), "cam0", OPTIONS)
    followed = follow(photograph(alone.scene, moved[:6]), setup, lost=(1,), pose=pose)
    assert followed.attempt is not None and followed.attempt.objects[0].status == "ok"
    assert np.linalg.norm(se3.exp(followed.attempt.pose[:6])[:3, 3] - moved[:3]) < 1e-3
    assert followed.attempt.qualities == {}


@pytest.fixture(scope="module")
def bent() -> np.ndarray:
    """The pose with the right index finger in the palm."""
    pose = POSE.copy()
    own = 6 + list_finger_angles(RIGHT, 1)
    pose[own] = np.r_[np.zeros(6), curl_fingers(RIGHT, 0.9)][own]
    return pose


def test_a_finger_that_jumped_is_found_by_a_second_try_in_the_same_frame(bent):
    followed = follow(photograph(BOTH.scene, POSE), pose=bent)
    assert followed.attempt is not None and not followed.attempt.lost
    assert joint_errors(BOTH, followed.attempt.pose, POSE)[0] < 3e-3
    assert followed.second_try.is_over


def test_a_thing_that_no_finger_explains_is_searched_once_and_then_not_for_some_frames():
    alone = TrackSetup(("right",), (RIGHT,), "cam0", OPTIONS)
    pose = POSE[: RIGHT.num_dofs]
    frame = photograph(alone.scene, pose)
    assert frame.depth is not None and frame.is_hand is not None
    depth, is_hand = frame.depth.copy(), frame.is_hand.copy()
    depth[60:69, 157:166], is_hand[60:69, 157:166] = 0.40, True  # smaller than a hand that is lost would leave
    strange = replace(frame, depth=depth, is_hand=is_hand)
    first = follow(strange, alone, pose=pose)
    assert first.attempt is not None and first.attempt.misfit > UNSETTLED and not first.attempt.lost
    assert first.second_try == Patience(FINGER_REST[0], FINGER_REST[0])
    second = follow(strange, alone, pose=first.attempt.pose, second_try=first.second_try)
    assert second.second_try == first.second_try.pass_frame()
