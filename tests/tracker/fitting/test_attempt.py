"""Attempts are compared by what they explain; another try mends what a fit from a wrong start leaves."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.grips import ball
from tests.tracker.scenes import CAMERA, palm_to_camera, photograph
from tracker.capture.frame import Frame
from tracker.fitting.attempt import (
    DISTANCE_LOSS,
    LOST_LOSS,
    MIN_PIXELS,
    MISFIT_LOSS,
    UNSETTLED,
    Attempt,
    attempt_fit,
    look,
    try_again,
)
from tracker.fitting.finger_search import curl_fingers, list_finger_angles
from tracker.fitting.frame_fit import Fit, FitOptions
from tracker.fitting.objective import Objective
from tracker.fitting.options import TrackOptions
from tracker.fitting.quality import MISFIT, SHOWN, Quality
from tracker.fitting.setup import TrackSetup
from tracker.fitting.sighting import SEEN, Sighting, Sightings
from tracker.landmarks import DetectedHand
from tracker.model.default_hand import default_hand

RIGHT, LEFT = default_hand("right"), default_hand("left")
OPTIONS = TrackOptions(calibrate=False)
SETUP = TrackSetup(("right",), (RIGHT,), "cam0", OPTIONS)
POSE = palm_to_camera(RIGHT, (0.0, 0.0, 0.45))
GOOD = Quality(0.002, 0.9, 0.9, 0.9, 0.8, 0.9, 0.0, 0.0, 2 * SHOWN)
LOST, GONE = replace(GOOD, misfit=2 * MISFIT), replace(GOOD, score=0.1)


def attempt(*qualities: Quality) -> Attempt:
    return Attempt(np.zeros(6), dict(enumerate(qualities)), Fit(np.zeros(6), (), {}), {})


def see_joints(points: np.ndarray, frame: Frame, is_led: bool = False) -> Sightings:
    """A detector's joints (21, 2) px, all of them believed."""
    hand = DetectedHand(points, np.zeros((21, 3)), 1.0, 1.0)
    return Sightings(frame, CAMERA, {"right": Sighting(hand, np.full(21, SEEN), is_led)})


def fit(frame: Frame, start: np.ndarray, sightings: Sightings | None = None, iterations: int = 0) -> Attempt:
    seen = look(frame, CAMERA, SETUP, start)
    assert seen is not None
    return attempt_fit(SETUP, seen, start, start, Objective(), FitOptions(iterations=iterations), sightings)


def test_a_lost_hand_is_worse_than_any_that_is_followed_and_a_gone_one_is_lost():
    poor = replace(GOOD, score=0.46)
    for hands in ((poor, LOST), (LOST, poor)):
        assert attempt(*hands).quality is LOST
    both = attempt(LOST, GOOD, GONE)
    assert both.gone == (2,) and both.lost == (0, 2)
    assert both.worst == 2 and both.misfit == LOST.misfit
    assert attempt(GOOD, GOOD).gone == attempt(GOOD, GOOD).lost == ()


def test_worth_falls_with_misfit_with_joints_seen_elsewhere_and_with_being_lost():
    best = attempt(GOOD)
    assert best.worth == best.agreement == GOOD.score
    assert attempt(LOST).worth == pytest.approx(GOOD.score - MISFIT_LOSS * LOST.misfit - LOST_LOSS)
    apart = attempt(replace(GOOD, apart=1.0, worst_finger=1.0))
    assert not apart.lost, "the depth image settles it"
    assert apart.worth == pytest.approx(GOOD.score - DISTANCE_LOSS) and apart.agreement == best.agreement
    assert attempt(replace(GOOD, apart=0.0, worst_finger=0.0)).worth == best.worth


def test_the_order_of_hands_changes_neither_worth_nor_agreement():
    hands = (GOOD, LOST, replace(GOOD, apart=0.3, worst_finger=0.6))
    one, other = attempt(*hands), attempt(*hands[::-1])
    assert (one.worth, one.agreement, one.misfit) == pytest.approx((other.worth, other.agreement, other.misfit))
    assert one.quality is other.quality


def test_a_fit_from_where_the_hand_is_stays_there_and_one_from_near_by_comes_there():
    frame = photograph(SETUP.scene, POSE)
    joints = SETUP.scene.pose_at(POSE).landmarks(0)
    for start in (POSE, SETUP.scene.retract(POSE, np.r_[0.004, -0.004, 0.004, np.full(RIGHT.num_dofs - 3, 0.04)])):
        found = fit(frame, start, iterations=12)
        assert found.quality.score > 0.97 and found.misfit < UNSETTLED and not found.lost
        assert np.linalg.norm(SETUP.scene.pose_at(found.pose).landmarks(0) - joints, axis=1).mean() < 1e-3


def test_a_fit_is_also_judged_by_where_the_detector_saw_the_hand_and_by_whether_it_was_told():
    frame = photograph(SETUP.scene, POSE)
    points = CAMERA.project(SETUP.scene.pose_at(POSE).landmarks(0))
    there = fit(frame, POSE, see_joints(points, frame)).quality
    assert there.apart == pytest.approx(0.0, abs=1e-6) and there.worst_finger == pytest.approx(0.0, abs=1e-6)
    elsewhere = fit(frame, POSE, see_joints(points + 500.0, frame, is_led=True)).quality
    assert (elsewhere.apart, elsewhere.worst_finger, elsewhere.is_led) == (1.0, 1.0, True)
    nowhere = fit(frame, POSE, Sightings(frame, CAMERA, {})).quality
    assert nowhere.apart is None and nowhere == fit(frame, POSE).quality


def test_hands_and_objects_are_judged_under_their_own_number():
    setup = TrackSetup(("ball", "right"), (ball(0.03), RIGHT), "cam0", OPTIONS)
    pose = np.r_[0.13, 0.0, 0.45, 0.0, 0.0, 0.0, POSE]
    frame = photograph(setup.scene, pose)
    seen = look(frame, CAMERA, setup, pose)
    assert seen is not None
    found = attempt_fit(setup, seen, pose, pose, Objective(), FitOptions(iterations=0))
    assert list(found.qualities) == [1] and list(found.objects) == [0]
    assert found.objects[0].status == "ok" and not found.lost


@pytest.mark.parametrize("finger", [1, 3])
def test_a_finger_that_was_taken_for_bent_is_found_by_another_try(finger):
    frame, bent = photograph(SETUP.scene, POSE), POSE.copy()
    own = 6 + list_finger_angles(RIGHT, finger)
    bent[own] = np.r_[np.zeros(6), curl_fingers(RIGHT, 0.9)][own]
    seen = look(frame, CAMERA, SETUP, bent)
    assert seen is not None
    options = FitOptions(iterations=6)
    first = attempt_fit(SETUP, seen, bent, bent, Objective(), options)
    assert first.misfit > UNSETTLED, "descent alone does not get there"
    again = try_again(SETUP, seen, bent, Objective(), Objective(), options)
    assert again.worth > first.worth + 0.05
    assert not again.lost and again.quality.score > 0.95


def test_what_is_looked_at_has_enough_hand_in_sight():
    empty = replace(photograph(SETUP.scene, POSE), depth=np.zeros((240, 320), np.float32))
    column, row = np.rint(CAMERA.project(SETUP.scene.pose_at(POSE).landmarks(0)[:1]))[0].astype(int)
    for count, is_seen in ((0, False), (MIN_PIXELS - 1, False), (MIN_PIXELS, True)):
        depth, is_hand = np.zeros((240, 320), np.float32), np.zeros((240, 320), np.bool_)
        depth[row, column - 60 : column - 60 + count] = 0.45
        is_hand[depth > 0] = True
        assert (look(replace(empty, depth=depth, is_hand=is_hand), CAMERA, SETUP, POSE) is not None) is is_seen
        other = look(replace(empty, depth=depth, is_hand=~is_hand), CAMERA, SETUP, POSE)
        assert other is None, "pixels of another thing are no hand"
    assert look(empty, CAMERA, SETUP, POSE, min_pixels=0) is not None


def test_a_pose_out_of_sight_is_not_looked_at_however_little_is_asked_for():
    frame = photograph(SETUP.scene, POSE)
    for place in ((2.0, 0.0, 0.45), (0.0, -2.0, 0.45), (0.0, 0.0, -0.45)):
        assert look(frame, CAMERA, SETUP, palm_to_camera(RIGHT, place), min_pixels=0) is None


def test_a_camera_near_by_is_looked_at_through_fewer_of_its_pixels():
    near = palm_to_camera(RIGHT, (0.0, 0.0, 0.16))
    fine = replace(CAMERA, width=640, height=480, K=np.array([[600.0, 0, 319.5], [0, 600.0, 239.5], [0, 0, 1.0]]))
    seen = look(photograph(SETUP.scene, near, fine), fine, SETUP, near)
    assert seen is not None and seen.K[0, 0] < 600.0
    assert seen.labels.shape[0] < 480
