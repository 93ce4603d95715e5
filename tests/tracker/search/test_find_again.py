"""Lost hands are looked for where they were, where the detector sees them, and in a part of the image a frame."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.scenes import CAMERA, palm_to_camera, photograph
from tracker.capture.frame import Frame
from tracker.fitting.objective import Objective
from tracker.fitting.options import TrackOptions
from tracker.fitting.setup import TrackSetup
from tracker.fitting.sighting import SEEN, Sighting, Sightings
from tracker.landmarks import DetectedHand
from tracker.model.default_hand import default_hand
from tracker.search.find_again import COARSE, MIN_AREA, STEPS, _is_hand_left, find_again, find_seen
from tracker.search.tools import Tools

RIGHT, LEFT = default_hand("right"), default_hand("left")
SETUP = TrackSetup(("right", "left"), (RIGHT, LEFT), "cam0", TrackOptions(calibrate=False))
TOOLS = Tools(Objective(), None, None)
POSE = np.r_[palm_to_camera(RIGHT, (-0.09, 0.0, 0.45)), palm_to_camera(LEFT, (0.09, 0.0, 0.45), 0.2)]
BOTH = photograph(SETUP.scene, POSE)
FIRST, SECOND = SETUP.scene.pose_slices


def sightings(frame: Frame, *seen: str) -> Sightings:
    """A frame, and a detector that sees some hands where they are in POSE."""
    posed, hands = SETUP.scene.pose_at(POSE), {}
    for name in seen:
        joints = posed.landmarks(SETUP.names.index(name))
        hand = DetectedHand(CAMERA.project(joints), joints - joints.mean(axis=0), 1.0, float(name == "right"))
        hands[name] = Sighting(hand, np.full(21, SEEN))
    return Sightings(frame, CAMERA, hands, is_looked_at=bool(seen))


def only(*models: int) -> Frame:
    """The frame in which only some hands are."""
    setup = TrackSetup(
        tuple(SETUP.names[m] for m in models), tuple(SETUP.models[m] for m in models), "cam0", SETUP.options
    )
    return photograph(setup.scene, np.concatenate([POSE[SETUP.scene.pose_slices[m]] for m in models]))


def joint_errors(pose: np.ndarray, hand: int) -> float:
    """Mean distance from POSE, m."""
    joints = [SETUP.scene.pose_at(each).landmarks(hand) for each in (pose, POSE)]
    return float(np.linalg.norm(joints[0] - joints[1], axis=1).mean())


def test_a_hand_that_is_back_in_its_last_place_is_found_there_in_any_step():
    for step in (0, 3, 1000):
        found = find_again(sightings(BOTH), SETUP, TOOLS, POSE, (1,), step)
        assert found is not None
        attempt, still = found
        assert still == () and not attempt.lost
        assert joint_errors(attempt.pose, 0) < 1e-3 and joint_errors(attempt.pose, 1) < 1e-3


@pytest.mark.parametrize("lost", [(0,), (1,)])
def test_a_hand_that_left_while_the_other_stays_is_not_looked_for_in_the_others_pixels(lost):
    frame = only(1 - lost[0])
    assert find_again(sightings(frame), SETUP, TOOLS, POSE, lost, 0) is None


def test_an_empty_image_has_no_hand_to_find():
    empty = replace(BOTH, depth=np.zeros_like(BOTH.depth))
    assert find_again(sightings(empty), SETUP, TOOLS, POSE, (0, 1), 0) is None
    assert find_seen(sightings(empty), SETUP, TOOLS, POSE, (0, 1)) is None


@pytest.mark.parametrize(("share", "is_left"), [(0.8, False), (1.25, True)])
def test_there_is_something_to_search_from_as_much_hand_as_a_fingertip_has_however_many_pixels_that_are(share, is_left):
    for z in (0.2, 0.4):
        depth, is_hand = np.zeros((240, 320), np.float32), np.zeros((240, 320), np.bool_)
        side = round(300.0 / z * (share * MIN_AREA) ** 0.5 / COARSE) * COARSE  # px
        depth[20 : 20 + side, 20 : 20 + side], is_hand[20 : 20 + side, 20 : 20 + side] = z, True
        for shown in (is_hand, None):
            assert _is_hand_left(Frame(0, "cam0", None, depth, shown), CAMERA, SETUP, POSE, (0,)) == is_left
        assert not _is_hand_left(Frame(0, "cam0", None, depth, ~is_hand), CAMERA, SETUP, POSE, (0,))


def test_a_part_of_the_search_comes_again_after_all_others_and_no_two_of_a_round_are_alike():
    def look(step: int) -> list[float] | None:
        found = find_again(sightings(BOTH), SETUP, TOOLS, np.r_[POSE[FIRST] + 0.5, POSE[SECOND]], (0,), step)
        return None if found is None else found[0].pose.tolist()

    one, two = look(4), look(5)
    assert one is not None and two is not None
    assert look(4 + STEPS) == one != two == look(5 + 3 * STEPS)


def test_of_frames_that_follow_each_other_one_finds_both_hands_that_nobody_knows_the_place_of():
    def is_found(step: int) -> bool:
        found = find_again(sightings(BOTH), SETUP, TOOLS, np.zeros_like(POSE), (0, 1), step)
        if found is None:
            return False
        attempt, still = found
        assert not set(attempt.gone) - set(still)
        return still == () and max(joint_errors(attempt.pose, hand) for hand in (0, 1)) < 0.02

    assert any(is_found(step) for step in range(3, 3 + STEPS))


def test_a_hand_is_put_where_the_detector_sees_it_and_one_that_it_overlooks_stays_lost():
    away = POSE.copy()
    away[FIRST.start : FIRST.start + 3] += (0.3, 0.2, 0.1)
    found = find_seen(sightings(BOTH, "right"), SETUP, TOOLS, away, (0,))
    assert found is not None and found[1] == ()
    assert joint_errors(found[0].pose, 0) < 4e-3 and 0 not in found[0].gone
    away[SECOND.start : SECOND.start + 3] += 0.4
    both_lost = find_seen(sightings(BOTH, "right"), SETUP, TOOLS, away, (0, 1))
    assert both_lost is not None and both_lost[1] == (1,)
    assert joint_errors(both_lost[0].pose, 0) < 4e-3
    np.testing.assert_array_equal(both_lost[0].pose[SECOND], away[SECOND])
    assert list(both_lost[0].qualities) == [0]


def test_what_the_detector_does_not_see_or_sees_where_no_hand_is_is_not_found_by_it():
    assert find_seen(sightings(BOTH), SETUP, TOOLS, POSE, (0, 1)) is None
    assert find_seen(sightings(BOTH, "right"), SETUP, TOOLS, POSE, (1,)) is None
    assert find_seen(sightings(only(0), "left"), SETUP, TOOLS, POSE, (1,)) is None
