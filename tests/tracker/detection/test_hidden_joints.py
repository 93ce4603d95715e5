"""What stands before a joint hides it; the hand itself, what is beside it and what nobody sees do not."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import numpy.typing as npt
import pytest

from tracker.capture.frame import Frame
from tracker.capture.grey import is_grey
from tracker.capture.sequence import Sequence, load_sequence
from tracker.cli.__main__ import main
from tracker.detection.hidden_joints import find_hidden_joints
from tracker.landmarks import DetectedHand, HandDetector

BOX = (5, 6, 7, 8)
"""The index finger, before which the tests hold a box."""


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Sequence:
    out = tmp_path_factory.mktemp("recordings") / "open"
    assert main(["synthesize", "--motion", "open-close", "--frames", "0:1", "--out", str(out)]) == 0
    return load_sequence(out)


@pytest.fixture
def open_hand(recording: Sequence) -> tuple[DetectedHand, Frame, float]:
    """An open hand as the detector finds it."""
    frame, focal = recording.frame(0, "cam0"), float(recording.camera("cam0").K[0, 0])
    assert frame.color is not None
    [hand] = HandDetector().find(frame.color, 1)
    return hand, frame, focal


def hold_box(hand: DetectedHand, frame: Frame, metres: float) -> Frame:
    """The frame with a green box before, or behind, the index finger."""
    assert frame.color is not None and frame.depth is not None
    place = np.zeros(frame.depth.shape, dtype=np.uint8)
    cv2.fillConvexPoly(place, cv2.convexHull(hand.points[list(BOX)].astype(np.int32)), 1)
    place = cv2.dilate(place, np.ones((9, 9), dtype=np.uint8)) > 0
    middle = float(np.median(frame.depth[frame.depth > 0]))
    color, depth = frame.color.copy(), frame.depth.copy()
    color[place], depth[place] = (30, 160, 60), middle + metres
    return replace(frame, color=color, depth=depth)


def told(hidden: npt.NDArray[np.bool_]) -> set[int]:
    return set(np.flatnonzero(hidden).tolist())


def test_an_open_hand_hides_nothing_of_itself(open_hand: tuple[DetectedHand, Frame, float]) -> None:
    assert told(find_hidden_joints(*open_hand)) == set()


@pytest.mark.parametrize(("is_in_color", "before"), [(True, 0.03), (True, 0.12), (False, 0.12)])
def test_joints_behind_a_box_are_hidden_and_no_others(
    open_hand: tuple[DetectedHand, Frame, float], is_in_color: bool, before: float
) -> None:
    hand, frame, focal = open_hand
    seen = hold_box(hand, frame, -before)
    assert seen.color is not None
    if not is_in_color:
        grey = cv2.cvtColor(seen.color, cv2.COLOR_RGB2GRAY)
        seen = replace(seen, color=np.repeat(grey[..., None], 3, axis=2))
        assert seen.color is not None and is_grey(seen.color)
    assert told(find_hidden_joints(hand, seen, focal)) == set(BOX)


def test_a_wall_behind_a_joint_that_is_told_wrongly_does_not_hide_it(
    open_hand: tuple[DetectedHand, Frame, float],
) -> None:
    hand, frame, focal = open_hand
    assert told(find_hidden_joints(hand, hold_box(hand, frame, 0.4), focal)) == set()


def test_without_depth_nothing_is_known_to_be_hidden(open_hand: tuple[DetectedHand, Frame, float]) -> None:
    hand, frame, focal = open_hand
    assert told(find_hidden_joints(hand, replace(frame, depth=None), focal)) == set()
    empty = replace(hold_box(hand, frame, -0.06), depth=np.zeros((480, 640), dtype=np.float32))
    assert told(find_hidden_joints(hand, empty, focal)) == set()


def test_joints_outside_the_image_are_not_looked_at(open_hand: tuple[DetectedHand, Frame, float]) -> None:
    hand, frame, focal = open_hand
    for shift in ((-5000.0, -5000.0), (5000.0, 5000.0), (-300.0, 0.0)):
        find_hidden_joints(replace(hand, points=hand.points + shift), frame, focal)  # raises nothing
    far = replace(hand, points=hand.points + 5000.0)
    assert told(find_hidden_joints(far, frame, focal)) == set()


@pytest.mark.shared_data
def test_fingertips_that_people_see_beside_a_real_box_are_not_hidden(shared_data: Path) -> None:
    folder, detector = shared_data / "uvr_cube_white", HandDetector()
    marked = json.loads((folder / "tips.json").read_text())["frames"]
    tips = {"thumb": 4, "index": 8, "middle": 12, "ring": 16, "little": 20}
    seen, hidden = [], []
    for index in map(int, marked):
        color = cv2.imread(str(sorted((folder / "c2d").glob("*.png"))[index]))
        depth = cv2.imread(str(sorted((folder / "depth").glob("*.png"))[index]), cv2.IMREAD_UNCHANGED)
        assert color is not None and depth is not None
        frame = Frame(
            index, "cam0", cv2.cvtColor(color, cv2.COLOR_BGR2RGB).astype(np.uint8), depth.astype(np.float32) / 1000.0
        )
        assert frame.color is not None
        for hand in detector.find(frame.color, 1):
            found = find_hidden_joints(hand, frame, 238.95)
            seen += [not found[tips[finger]] for finger in marked[str(index)]]
            hidden.append(int(found.sum()))
    assert len(seen) >= 12 and np.mean(seen) >= 0.85
    assert np.mean(np.array(hidden) > 0) >= 0.7, "the box hides some knuckles in nearly every frame"
