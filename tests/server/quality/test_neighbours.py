"""Checks against the frames before and after: swapped hands, joints that jump, labels of another frame."""

from __future__ import annotations

import numpy as np

from server.quality.finding import Looked
from server.quality.neighbours import REACH_FRAMES, check_handedness, check_jumps
from tests.server.quality.drawn_hands import draw_hand, label

HANDS = ("right", "left")
BESIDE = np.array([-180.0, 0.0])


def move(x: float, y: float = 0.0) -> np.ndarray:
    """(21, 2) px: the hand elsewhere in the image."""
    return draw_hand() + np.array([x, y])


def test_hands_that_stay_raise_nothing() -> None:
    labels = [
        *(label(frame=frame) for frame in range(5)),
        *(label(draw_hand() + BESIDE, frame, "left") for frame in range(5)),
    ]
    looked = Looked()
    assert list(check_handedness(labels, HANDS, looked)) == [] and list(check_jumps(labels, looked)) == []
    assert looked.find("jump") == looked.find("handedness") == {one.id for one in labels}


def test_two_hands_swapped_in_one_frame_are_both_found() -> None:
    labels = []
    for frame in range(5):
        right, left = draw_hand(), draw_hand() + BESIDE
        if frame == 2:
            right, left = left, right
        labels += [label(right, frame, "right"), label(left, frame, "left")]
    found = list(check_handedness(labels, HANDS, Looked()))
    assert {(one.label.frame, one.label.hand) for one in found} == {(2, "right"), (2, "left")}
    assert all("are they swapped?" in one.reason for one in found)


def test_a_hand_that_the_recording_is_said_not_to_have_is_found() -> None:
    [found] = check_handedness([label(hand="left")], ("right",), Looked())
    assert found.reason == "This recording is said to have no left hand."


def test_one_joint_that_jumps_is_named_and_its_neighbours_are_not_blamed() -> None:
    labels = []
    for frame in range(5):
        pixels = move(4.0 * frame)  # the hand moves on
        if frame == 2:
            pixels[8] += [60.0, 0.0]
        labels.append(label(pixels, frame))
    [found] = check_jumps(labels, Looked())
    assert (found.label.frame, found.joints) == (2, (8,)) and "index tip is 60 px" in found.reason


def test_a_hand_that_moves_as_a_whole_does_not_jump() -> None:
    labels = [label(move(15.0 * frame, -9.0 * frame), frame) for frame in range(6)]
    assert list(check_jumps(labels, Looked())) == []


def test_the_label_of_another_frame_is_found_as_a_whole() -> None:
    shifts = [0.0, 0.0, 150.0, 0.0, 0.0]
    labels = [label(move(shift), frame) for frame, shift in enumerate(shifts)]
    [found] = check_jumps(labels, Looked())
    assert (found.label.frame, found.joints) == (2, ())
    assert "150 px from where frames 1 and 3 have it" in found.reason


def test_frames_far_apart_say_nothing_about_each_other() -> None:
    far = draw_hand()
    far[8] += [60.0, 0.0]
    labels, looked = [label(frame=0), label(far, REACH_FRAMES + 1)], Looked()
    assert list(check_jumps(labels, looked)) == [] and looked.find("jump") == frozenset()


def test_cameras_are_looked_at_one_by_one() -> None:
    moved = draw_hand()
    moved[8] += [60.0, 0.0]
    labels = [label(frame=0), label(moved, 0, camera="cam1"), label(frame=1), label(moved, 1, camera="cam1")]
    assert list(check_jumps(labels, Looked())) == []
