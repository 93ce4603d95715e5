"""The detector's hands against each other: a camera that disagrees, and bones of an unusual length in space."""

from __future__ import annotations

import numpy as np
import pytest

from server.quality.detections import LEAST_M, LEAST_SHARE, check_bones_in_space, check_detections
from server.quality.evidence import DETECTOR_PX, DETECTOR_SHARE, LEAST_JOINTS
from server.quality.hand import EDGES, find_bone_lengths
from server.quality.views import Views, measure_size
from tests.server.quality.drawn_hands import HAND, K, cameras, draw_hand, seen


def marks(count: int, frames: range = range(1)) -> dict:
    return {(f"cam{number}", frame, "right"): seen(number) for number in range(count) for frame in frames}


def left_out(found) -> list:
    return [doubt for doubt in found if doubt.kind == "left_out"]


def test_cameras_that_agree_raise_no_doubt_worth_a_look() -> None:
    assert max(doubt.score for doubt in check_detections(marks(3), cameras())) < 1e-3


def test_of_three_cameras_the_one_that_is_off_is_the_worst_and_its_score_is_by_the_hands_size() -> None:
    detected = marks(3)
    detected["cam1", 0, "right"] = detected["cam1", 0, "right"] + (0.0, 40.0)
    found = left_out(check_detections(detected, cameras()))
    worst = max(found, key=lambda one: one.score)
    limit = max(DETECTOR_PX, DETECTOR_SHARE * measure_size(HAND))
    assert (worst.camera, worst.frame, worst.hand, worst.joints) == ("cam1", 0, "right", ())
    assert worst.score == pytest.approx(40.0 / limit, rel=0.02)
    assert worst.reason == "In cam1 the detector saw the hand 40 px from where the other cameras see it."


def test_of_two_cameras_both_are_as_far_off_and_neither_is_blamed() -> None:
    detected = marks(2)
    detected["cam1", 0, "right"] = detected["cam1", 0, "right"] + (0.0, 40.0)
    first, second = left_out(check_detections(detected, cameras(2)))
    assert first.score == pytest.approx(second.score, rel=0.02)
    assert first.reason == "In cam0 the detector saw the hand 20 px from where both cameras together put it."


@pytest.mark.parametrize(("joints", "told"), [(LEAST_JOINTS - 1, 0), (LEAST_JOINTS, 2)])
def test_a_hand_with_too_few_joints_in_both_cameras_is_not_judged(joints: int, told: int) -> None:
    detected = marks(2)
    for place in detected:
        detected[place] = np.where(np.arange(21)[:, None] < joints, detected[place], np.nan)
    assert len(left_out(check_detections(detected, cameras(2)))) == told


def test_no_detection_and_one_camera_alone_raise_nothing() -> None:
    assert list(check_detections({}, cameras())) == []
    assert list(check_detections(marks(1), cameras())) == []


def place(frame: int, joints: np.ndarray, hand: str = "right") -> Views:
    return Views(frame, hand, ("cam0", "cam1"), joints, np.zeros((21, 2)), np.zeros((21, 2)))


def in_space() -> np.ndarray:
    """(21, 3) m: the drawn hand, whose bones are the default hand's."""
    return np.column_stack([draw_hand() * 0.5 / K[0, 0], np.full(21, 0.5)])


def stretch(joints: np.ndarray, bone: int, by: float) -> np.ndarray:
    """A fingertip moved along its own bone, m."""
    a, b = EDGES[bone]
    moved = joints.copy()
    moved[b] += by * (joints[b] - joints[a]) / np.linalg.norm(joints[b] - joints[a])
    return moved


def test_a_bone_longer_than_usual_is_told_with_both_lengths_and_its_score() -> None:
    bone, by = 7, 0.03
    usual = find_bone_lengths()[bone]
    views = [place(frame, in_space()) for frame in range(6)] + [place(6, stretch(in_space(), bone, by))]
    found = {doubt.frame: doubt for doubt in check_bones_in_space(views, "the marks")}
    assert found[6].joints == tuple(EDGES[bone]) == (7, 8) and found[6].camera == ""
    assert found[6].score == pytest.approx(by / (LEAST_M + LEAST_SHARE * usual))
    assert found[6].reason == (
        f"By the marks, index dip to index tip is {1e3 * (usual + by):.0f} mm; in this recording it usually is "
        f"{1e3 * usual:.0f} mm."
    )
    assert max(found[frame].score for frame in range(6)) < 1e-6


def test_each_hand_is_compared_with_its_own_usual() -> None:
    small = 0.8 * in_space()
    views = [place(frame, in_space()) for frame in range(5)] + [place(frame, small, "left") for frame in range(5)]
    found = list(check_bones_in_space(views, "the marks"))
    assert len(found) == 10 and max(doubt.score for doubt in found) < 1e-6


def test_a_hand_without_any_bone_in_space_is_passed_over() -> None:
    nothing = place(3, np.full((21, 3), np.nan))
    assert [doubt.frame for doubt in check_bones_in_space([place(0, in_space()), nothing], "the marks")] == [0]
    assert list(check_bones_in_space([], "the marks")) == []
