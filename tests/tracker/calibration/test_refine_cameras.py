"""Cameras refined from labels."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.calibration.labelled_hands import find_farthest_off_px, knock, mark_hands, stand_around
from tracker.calibration.refine_cameras import MAX_UNSURE_PX, refine_cameras
from tracker.capture.annotations import Annotations
from tracker.capture.joint_source import JointSource
from tracker.errors import CalibrationError


def find_baseline(cameras) -> float:
    return float(np.linalg.norm(cameras[-1].T_world_camera[:3, 3] - cameras[0].T_world_camera[:3, 3]))


@pytest.mark.parametrize("count", [2, 3, 5])
def test_exact_labels_bring_cameras_back_that_somebody_knocked(count: int, rng: np.random.Generator) -> None:
    truth = stand_around(count)
    knocked = knock(truth, rng)
    found = refine_cameras(knocked, mark_hands(truth, 20, rng, noise_px=0.0))
    assert find_farthest_off_px(knocked, truth) > 5
    assert find_farthest_off_px(found.cameras, truth) < 0.001
    assert found.refusal == ""


def test_labels_as_annotators_make_them_bring_four_cameras_near(rng: np.random.Generator) -> None:
    truth = stand_around(4)
    knocked = knock(truth, rng)
    found = refine_cameras(knocked, mark_hands(truth, 40, rng))
    off = find_farthest_off_px(found.cameras, truth)
    assert off < 3 < find_farthest_off_px(knocked, truth) / 3
    assert off < 3 * max(camera.unsure_px for camera in found.described)
    for camera in found.described:
        assert camera.left_out_after.rms < camera.left_out_before.rms < 20
        assert camera.left_out_after.joints == 8 * 21 and camera.fitted_after.joints == 32 * 21
    assert found.refusal == ""


def test_the_first_camera_and_the_longest_baseline_stay(rng: np.random.Generator) -> None:
    truth = stand_around(4)
    knocked = knock(truth, rng)
    found = refine_cameras(knocked, mark_hands(truth, 20, rng))
    assert np.array_equal(found.cameras[0].T_world_camera, knocked[0].T_world_camera)
    assert find_baseline(found.cameras) == pytest.approx(find_baseline(knocked), rel=1e-6)
    assert "labels give no scale" in found.kept
    assert [camera.is_moved for camera in found.described] == [False, True, True, True]


def test_the_movement_told_is_the_movement_made(rng: np.random.Generator) -> None:
    truth = stand_around(3)
    knocked = knock(truth, rng, mm=0.0, deg=1.5)
    found = refine_cameras(knocked, mark_hands(truth, 20, rng, noise_px=0.0))
    for camera in found.described[1:]:
        assert camera.turned_deg == pytest.approx(1.5, abs=0.001) and camera.moved_mm < 0.01


def test_wrong_marks_move_cameras_little(rng: np.random.Generator) -> None:
    truth = stand_around(3)
    labels = mark_hands(truth, 30, rng, noise_px=0.3)
    for item in labels.items:
        item.points[rng.integers(21), :2] += 40.0
    found = refine_cameras(knock(truth, rng), labels)
    assert find_farthest_off_px(found.cameras, truth) < 4 and found.refusal == ""


@pytest.mark.slow
def test_a_wrong_focal_length_is_made_up_for_when_lenses_may_change_and_not_otherwise(rng: np.random.Generator) -> None:
    truth = stand_around(4)
    wrong = list(truth)
    wrong[2] = replace(truth[2], K=truth[2].K * [[1.02], [1.02], [1.0]])
    labels = mark_hands(truth, 40, rng, noise_px=0.0)
    stiff = refine_cameras(wrong, labels)
    free = refine_cameras(wrong, labels, lenses=True)
    assert free.described[2].left_out_after.rms < 0.05 < stiff.described[2].left_out_after.rms
    assert all(camera.left_out_after.rms < 0.05 for camera in free.described)


def test_few_labels_with_noise_do_not_tell_lenses_and_are_refused(rng: np.random.Generator) -> None:
    truth = stand_around(2)
    labels = mark_hands(truth, 30, rng)
    stiff, free = (refine_cameras(knock(truth, rng), labels, lenses) for lenses in (False, True))
    assert free.described[0].unsure_px > 10 > stiff.described[1].unsure_px
    assert "too few, to tell" in free.refusal


def test_cameras_that_are_right_are_left_alone(rng: np.random.Generator) -> None:
    truth = stand_around(3)
    found = refine_cameras(truth, mark_hands(truth, 60, rng))
    assert "already agree as well as labels" in found.refusal


def test_labels_all_in_one_place_are_refused(rng: np.random.Generator) -> None:
    truth = stand_around(2)
    found = refine_cameras(knock(truth, rng), mark_hands(truth, 20, rng, spread_m=0.0))
    assert found.refusal.startswith("The labels lie too close together, or are too few, to tell where cam1 stands")
    assert found.described[1].unsure_px > MAX_UNSURE_PX


def test_too_few_labels_are_refused_with_what_is_needed(rng: np.random.Generator) -> None:
    truth = stand_around(2)
    with pytest.raises(CalibrationError, match=r"Labels of 3 frames have joints in two cameras; needed 5"):
        refine_cameras(truth, mark_hands(truth, 3, rng))
    alone = Annotations(tuple(item for item in mark_hands(truth, 9, rng).items if item.camera == "cam0"))
    with pytest.raises(CalibrationError, match=r"No two cameras share more than 0 labelled joints; needed 20"):
        refine_cameras(truth, alone)


def test_joints_that_the_cameras_made_say_nothing_about_them(rng: np.random.Generator) -> None:
    truth = stand_around(2)
    labels = mark_hands(truth, 20, rng)
    for kind in ("triangulation", "track", "interpolation", "copy"):
        sources = (JointSource(kind),) * 21
        made = tuple(replace(item, sources=sources) if item.camera == "cam1" else item for item in labels.items)
        with pytest.raises(CalibrationError, match="agree with the cameras they came from"):
            refine_cameras(truth, Annotations(made))
    guessed = [replace(item, points=item.points * [1, 1, 0.5]) for item in labels.items]
    with pytest.raises(CalibrationError, match="marked as visible"):
        refine_cameras(truth, Annotations(tuple(guessed)))


def test_a_camera_without_labels_stays_where_it_is(rng: np.random.Generator) -> None:
    truth = stand_around(4)
    knocked = knock(truth, rng)
    labels = Annotations(tuple(item for item in mark_hands(truth, 20, rng).items if item.camera != "cam0"))
    found = refine_cameras(knocked, labels)
    assert found.cameras[0] is knocked[0] and found.kept.startswith("cam1 stands still")
    assert [camera.is_moved for camera in found.described] == [False, False, True, True]
    assert "cam0         stays as it is" in found.say()
