"""Videos out of step, recognised by the motion of hands."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.calibration.labelled_hands import PLACE, stand_around
from tracker.calibration.hand_offsets import find_hand_offsets
from tracker.capture.annotations import Annotation, Annotations
from tracker.errors import CalibrationError

FPS = 30.0


def see_hands(cameras, late: dict[str, float], rng, frames: int = 240, speed: float = 1.0) -> Annotations:
    """A hand that is waved, as a detector with 2 px of noise sees it; frames by which a moment is later in cameras."""
    shape = 0.04 * rng.normal(size=(21, 3))
    items = []
    for camera in cameras:
        for frame in range(frames):
            t = speed * (frame - late.get(camera.id, 0.0)) / FPS
            way = [0.12 * np.sin(2.1 * t), 0.1 * np.sin(3.3 * t + 1), 0.08 * np.sin(1.3 * t)]
            pixels = camera.project(PLACE + np.array(way) + shape) + 2.0 * rng.normal(size=(21, 2))
            items.append(Annotation(frame, camera.id, "right", np.column_stack([pixels, np.full(21, 2.0)])))
    return Annotations(tuple(items))


@pytest.mark.parametrize("late", [0.0, 3.0, -7.0, 12.4])
def test_an_offset_comes_back_to_a_fraction_of_a_frame(late: float, rng: np.random.Generator) -> None:
    cameras = stand_around(3)
    second, third = find_hand_offsets(cameras, see_hands(cameras, {"cam1": late}, rng), FPS, 30)
    assert second.is_known and second.frames == pytest.approx(late, abs=0.25)
    assert second.seconds == pytest.approx(second.frames / FPS) and second.std_frames < 0.25
    assert third.is_known and third.frames == pytest.approx(0.0, abs=0.25)
    words = "is in step with cam0" if late == 0 else f"cam1={round(late):+d}"
    assert words in second.say("cam0")


def test_a_hand_that_rests_tells_no_offset(rng: np.random.Generator) -> None:
    cameras = stand_around(2)
    (found,) = find_hand_offsets(cameras, see_hands(cameras, {"cam1": 5.0}, rng, speed=0.0), FPS, 30)
    assert not found.is_known and "does not tell whether it is in step" in found.say("cam0")


def test_an_offset_beyond_reach_is_not_told(rng: np.random.Generator) -> None:
    cameras = stand_around(2)
    (found,) = find_hand_offsets(cameras, see_hands(cameras, {"cam1": 25.0}, rng), FPS, 8)
    assert not found.is_known


def test_hands_in_too_few_common_frames_are_refused(rng: np.random.Generator) -> None:
    cameras = stand_around(2)
    hands = see_hands(cameras, {}, rng, frames=20)
    with pytest.raises(CalibrationError, match=r"cam0 and cam1 see a hand in 20 common frames; needed 30"):
        find_hand_offsets(cameras, hands, FPS, 10)
    apart = [replace(item, hand="left") if item.camera == "cam1" else item for item in hands.items]
    with pytest.raises(CalibrationError, match=r"in 0 common frames"):
        find_hand_offsets(cameras, Annotations(tuple(apart)), FPS, 10)
