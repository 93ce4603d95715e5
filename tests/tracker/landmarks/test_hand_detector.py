"""Hands in real images, and images in which there are none."""

from __future__ import annotations

import json
from pathlib import Path

import cv2
import numpy as np
import numpy.typing as npt
import pytest

from tracker.landmarks import DetectedHand, HandDetector

Image = npt.NDArray[np.uint8]


@pytest.fixture(scope="module")
def detector() -> HandDetector:
    return HandDetector()


def _read(path: Path) -> Image:
    image = cv2.imread(str(path))
    assert image is not None
    return np.ascontiguousarray(image[..., ::-1])


@pytest.fixture(scope="module")
def ball(shared_data: Path) -> list[Image]:
    """Every fourth image of a right hand that holds a ball."""
    return [_read(path) for path in sorted((shared_data / "uvr_sphere_green" / "c2d").glob("*.png"))[::4]]


@pytest.mark.shared_data
def test_a_right_hand_is_found_and_followed_in_every_image(detector: HandDetector, ball: list[Image]) -> None:
    before: list[DetectedHand] = []
    for image in ball:
        before = detector.find(image, hands=1, before=before)
        assert [hand.side for hand in before] == ["right"]


@pytest.mark.shared_data
def test_a_mirrored_right_hand_is_a_left_one(detector: HandDetector, ball: list[Image]) -> None:
    sides = [hand.side for image in ball[::5] for hand in detector.find(np.ascontiguousarray(image[:, ::-1]), hands=1)]
    assert sides == ["left"] * len(ball[::5])


@pytest.mark.shared_data
def test_a_turned_image_has_turned_joints(detector: HandDetector, ball: list[Image]) -> None:
    upright = detector.find(ball[25], hands=1)[0].points
    height = ball[25].shape[0]
    turned = detector.find(np.ascontiguousarray(np.rot90(ball[25], -1)), hands=1)[0].points
    back = np.stack([turned[:, 1], height - 1 - turned[:, 0]], axis=1)
    assert np.linalg.norm(back - upright, axis=1).mean() < 3.0


@pytest.mark.shared_data
def test_a_hand_is_followed_in_infrared_images_of_a_cluttered_room(detector: HandDetector, shared_data: Path) -> None:
    video = cv2.VideoCapture(str(shared_data / "d405_take001" / "cam0_irL.avi"))
    before: list[DetectedHand] = []
    count = found = right = 0
    while (read := video.read())[0]:
        before = detector.find(cv2.cvtColor(read[1], cv2.COLOR_BGR2GRAY), hands=1, before=before)
        count, found = count + 1, found + len(before)
        right += sum(hand.side == "right" for hand in before)
    assert count == 126
    assert found >= 0.95 * count
    assert right >= 0.99 * found


@pytest.mark.shared_data
def test_fingertips_that_people_marked_are_found(detector: HandDetector, shared_data: Path) -> None:
    folder = shared_data / "uvr_cube_white"
    marked = json.loads((folder / "tips.json").read_text())["frames"]
    tips = {"thumb": 4, "index": 8, "middle": 12, "ring": 16, "little": 20}
    before: list[DetectedHand] = []
    apart = []
    for index, path in enumerate(sorted((folder / "c2d").glob("*.png"))):
        before = detector.find(_read(path), hands=1, before=before)
        for finger, place in marked.get(str(index), {}).items():
            apart.append(np.linalg.norm(before[0].points[tips[finger]] - place) if before else np.inf)
    assert len(apart) == 20
    assert np.mean(np.array(apart) <= 8.0) >= 0.8


@pytest.mark.shared_data
def test_a_red_tool_is_no_hand_in_a_larger_square_and_hands_are(detector: HandDetector, shared_data: Path) -> None:
    session = shared_data / "caliscope_sessions" / "charuco_calibration_2_cam"
    video = cv2.VideoCapture(str(session / "recordings" / "recording_1" / "cam_0.mp4"))
    told = {}
    for frame in (20, 58, 64, 70):
        video.set(cv2.CAP_PROP_POS_FRAMES, frame)
        image = np.ascontiguousarray(video.read()[1][..., ::-1])
        told[frame] = [detector.sees_wider(image, hand) for hand in detector.find(image, turns=(0, 1, 2, 3))]
    assert told == {20: [True, True], 58: [False], 64: [False], 70: [True, True]}


@pytest.mark.shared_data
def test_what_is_refused_is_not_given_back(detector: HandDetector, ball: list[Image]) -> None:
    (hand,) = detector.find(ball[0], 1)
    assert detector.find(ball[0], 1, [hand], accept=lambda _: False) == []


@pytest.mark.shared_data
def test_two_hands_are_two(detector: HandDetector, ball: list[Image]) -> None:
    image = np.concatenate([ball[0], ball[0][:, ::-1]], axis=1)
    found = detector.find(np.ascontiguousarray(image), hands=2)
    assert sorted(hand.side for hand in found) == ["left", "right"]
    again = detector.find(np.ascontiguousarray(image), hands=2, before=found)
    assert [hand.side for hand in again] == [hand.side for hand in found]


@pytest.mark.parametrize("shape", [(1, 1), (3, 500), (8, 8, 3), (240, 320, 3), (4000, 6000)])
def test_in_an_image_without_a_hand_none_is_found(detector: HandDetector, shape: tuple[int, ...]) -> None:
    assert detector.find(np.zeros(shape, dtype=np.uint8)) == []
    noise = np.random.default_rng(0).integers(0, 256, shape, dtype=np.uint8)
    assert detector.find(noise) == []


def test_a_hand_that_left_the_image_is_followed_no_more(detector: HandDetector) -> None:
    points = np.stack([np.linspace(900, 960, 21), np.linspace(-500, -400, 21)], axis=1)
    gone = DetectedHand(points, np.zeros((21, 3)), 1.0, 1.0)
    shrunk = DetectedHand(np.full((21, 2), 50.0), np.zeros((21, 3)), 1.0, 1.0)
    assert detector.find(np.zeros((240, 320, 3), dtype=np.uint8), before=[gone, shrunk]) == []
