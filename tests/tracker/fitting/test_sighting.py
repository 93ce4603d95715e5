"""What the detector sees: which hand it is, whether it can be one, and which joints are believed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.fitting.objective import Objective
from tracker.fitting.sighting import COVERED, NO_DEPTH, SEEN, find_sightings
from tracker.landmarks import DetectedHand
from tracker.model.default_hand import default_hand
from tracker.model.scene import Scene
from tracker.tracking.state import TrackState

CAMERA = Camera("cam0", 320, 240, np.array([[240.0, 0, 160], [0, 240.0, 120], [0, 0, 1]]), np.zeros(0), np.eye(4))
DISTANCE = 0.5


class Told:
    """A detector that sees what it is told: which images the networks understand is another test's."""

    def __init__(self, *hands: DetectedHand) -> None:
        self.hands = list(hands)
        self.asked: list[list[DetectedHand]] = []

    def find(self, image, hands, before, turns, accept):
        self.asked.append(list(before))
        return [hand for hand in self.hands if accept(hand)][:hands]


def hand_at(column: float, size: float = 1.0, right: float = 0.9) -> DetectedHand:
    """The default hand at rest, as a camera half a metre away sees it."""
    model = default_hand("right")
    joints = Scene((model,)).pose_at(Scene((model,)).rest_pose()).landmarks(0)
    joints = joints - joints.mean(axis=0)
    points = joints[:, :2] * size * CAMERA.K[0, 0] / DISTANCE + (column, 120.0)
    return DetectedHand(points, joints, 1.0, right)


def frame(hands: list[DetectedHand]) -> Frame:
    """Skin at the joints, half a metre away."""
    color = np.full((240, 320, 3), 20, dtype=np.uint8)
    depth = np.full((240, 320), 1.5, dtype=np.float32)
    for hand in hands:
        for column, row in np.rint(hand.points).astype(int):
            color[row - 4 : row + 5, column - 4 : column + 5] = (196, 140, 120)
            depth[row - 4 : row + 5, column - 4 : column + 5] = DISTANCE
    return Frame(0, "cam0", color, depth)


def test_the_only_hand_of_a_recording_has_its_name_whatever_side_it_looks_like():
    hand = hand_at(160, right=0.1)
    assert list(find_sightings(Told(hand), frame([hand]), CAMERA, ("right",), {}).hands) == ["right"]


@pytest.mark.parametrize("rights", [(0.9, 0.2), (0.55, 0.52), (0.3, 0.1)])
def test_of_two_hands_the_one_that_looks_more_like_a_right_one_is_it(rights):
    first, second = hand_at(90, right=rights[0]), hand_at(230, right=rights[1])
    seen = find_sightings(Told(second, first), frame([first, second]), CAMERA, ("left", "right"), {})
    assert seen.hands["right"].hand is first
    assert seen.hands["left"].hand is second
    assert seen.frame.is_hand is not None


class Near:
    """A detector that overlooks a hand until it is told where to look."""

    def __init__(self, *hands: DetectedHand) -> None:
        self.hands = list(hands)

    def find(self, image, hands, before, turns, accept):
        return [hand for hand in self.hands if before and accept(hand)]


def test_of_a_followed_hand_that_the_detector_overlooks_the_pixels_are_told_by_where_it_should_be():
    hand = hand_at(160)
    seen = find_sightings(Near(), frame([hand]), CAMERA, ("right",), {}, {"right": hand.points})
    assert seen.hands == {}
    assert seen.frame.is_hand is not None
    assert all(seen.frame.is_hand[row, column] for column, row in np.rint(hand.points).astype(int))


def test_a_hand_that_is_seen_only_where_the_fit_says_helps_but_is_no_witness_and_is_not_followed_on():
    hand = hand_at(160)
    seen = find_sightings(Near(hand), frame([hand]), CAMERA, ("right",), {}, {"right": hand.points + 3.0})
    assert seen.hands["right"].is_led and not seen.followed
    told = find_sightings(Told(hand), frame([hand]), CAMERA, ("right",), {}, {"right": hand.points + 3.0})
    assert not told.hands["right"].is_led and np.array_equal(told.followed["right"].points, hand.points)


def test_what_is_seen_far_from_where_the_hand_should_be_is_not_it():
    hand = hand_at(160)
    aside = {"right": hand.points + np.array([40.0, 0.0])}
    assert find_sightings(Near(hand), frame([hand]), CAMERA, ("right",), {}, aside).hands == {}


def test_a_fingertip_that_shows_where_it_is_expected_is_believed_in_place_of_a_detected_one_on_the_fingers_root():
    hand = hand_at(160)
    color, depth = np.full((240, 320, 3), 20, dtype=np.uint8), np.full((240, 320), 1.5, dtype=np.float32)
    for column, row in np.rint(np.delete(hand.points, (10, 11), axis=0)).astype(int):
        where = slice(row - 3, row + 4), slice(column - 3, column + 4)
        color[where], depth[where] = (196, 140, 120), DISTANCE
    points = hand.points.copy()
    points[10:13] = points[9]  # the network bends the middle finger to its root, which shows
    told = replace(hand, points=points)
    image = Frame(0, "cam0", color, depth)
    without = find_sightings(Told(told), image, CAMERA, ("right",), {}).hands["right"]
    assert np.array_equal(without.hand.points, points)
    expected = {"right": hand.points + 2.0}
    seen = find_sightings(Told(told), image, CAMERA, ("right",), {}, expected).hands["right"]
    assert np.linalg.norm(seen.hand.points[12] - hand.points[12]) < 1.5
    assert seen.beliefs[12] == SEEN and seen.beliefs[10] == seen.beliefs[11] == COVERED
    assert np.array_equal(np.delete(seen.hand.points, 12, axis=0), np.delete(points, 12, axis=0))


@pytest.mark.parametrize("size", [0.4, 2.5])
def test_what_is_too_small_or_large_for_its_distance_is_no_hand_and_is_not_followed(size):
    hand = hand_at(160, size)
    detector = Told(hand)
    assert find_sightings(detector, frame([hand]), CAMERA, ("right",), {"right": hand}).hands == {}
    assert detector.asked == [[hand]]


def test_of_a_hand_that_was_not_seen_no_pixel_is_taken_from_the_other():
    hand = hand_at(160)
    seen = find_sightings(Told(hand), frame([hand]), CAMERA, ("left", "right"), {})
    assert list(seen.hands) == ["right"]
    assert seen.frame.is_hand is None


def test_a_joint_behind_something_else_is_hardly_believed():
    hand = hand_at(160)
    image = frame([hand])
    column, row = np.rint(hand.points[8]).astype(int)
    image.color[row - 6 : row + 7, column - 6 : column + 7] = (20, 200, 40)
    column, row = np.rint(hand.points[20]).astype(int)
    image.depth[row - 6 : row + 7, column - 6 : column + 7] = 0.0
    beliefs = find_sightings(Told(hand), image, CAMERA, ("right",), {}).hands["right"].beliefs
    assert beliefs[8] == COVERED
    assert beliefs[20] == NO_DEPTH
    assert beliefs[0] == SEEN


def test_without_colour_or_detector_nothing_is_seen_and_the_frame_stays():
    hand = hand_at(160)
    image = frame([hand])
    for detector, given in ((None, image), (Told(hand), replace(image, color=None))):
        seen = find_sightings(detector, given, CAMERA, ("right",), {})
        assert seen.hands == {}
        assert seen.frame is given


def test_joints_that_were_seen_pull_and_the_rest_of_the_objective_stays():
    hand = hand_at(160)
    seen = find_sightings(Told(hand), frame([hand]), CAMERA, ("right",), {})
    scene = Scene((default_hand("right"),))
    objective = Objective()
    guided = seen.add_to(objective, scene, ("right",))
    assert set(guided.terms) - set(objective.terms) == {"joints_right"}


def test_a_fit_is_measured_by_all_joints_and_by_the_finger_that_is_farthest_off():
    hand = hand_at(160)
    seen = find_sightings(Told(hand), frame([hand]), CAMERA, ("right",), {}).hands["right"]
    assert seen.measure(hand.points) == (0.0, 0.0)
    assert seen.measure(hand.points + 1000.0) == (1.0, 1.0)
    bent = hand.points.copy()
    bent[5:9] += 1000.0
    assert seen.measure(bent) == pytest.approx((4 / 21, 1.0))
    hidden = replace(seen, beliefs=np.where(np.isin(np.arange(21), (6, 7, 8)), COVERED, SEEN))
    assert hidden.measure(bent)[1] == 0.0, "of a finger that is hidden nothing can be said"


def test_a_state_keeps_what_was_detected(tmp_path):
    hand = hand_at(160)
    TrackState(3, np.zeros(26), np.zeros(26), detected={"right": hand}).save(tmp_path / "state.npz")
    kept = TrackState.load(tmp_path / "state.npz").detected["right"]
    np.testing.assert_array_equal(kept.points, hand.points)
    np.testing.assert_array_equal(kept.points_3d, hand.points_3d)
    assert (kept.presence, kept.right) == (hand.presence, hand.right)
