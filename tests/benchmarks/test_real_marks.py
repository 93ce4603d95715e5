"""Joints that were found, against joints that people marked."""

from __future__ import annotations

import json

import numpy as np
import pytest

from benchmarks.real_marks.agreement import compare
from benchmarks.real_marks.changed import CHANGES, Change
from benchmarks.real_marks.corrections import count_corrections
from benchmarks.real_marks.marked import FOLDER, MarkedRecording
from benchmarks.real_marks.outlines import OUTLINES, compare_outline

LIMIT = 8.0
TIP = 8


def marks() -> np.ndarray:
    wanted = np.full((21, 2), np.nan)
    wanted[TIP] = (10.0, 10.0)
    return wanted


def found(off: float) -> np.ndarray:
    joints = np.zeros((21, 2))
    joints[TIP] = (10.0, 10.0 + off)
    return joints


def test_verdicts_are_held_against_the_marks():
    joints = {0: found(1.0), 1: found(1.0), 2: found(20.0), 3: found(20.0)}
    agreement = compare({frame: marks() for frame in range(4)}, joints, {1, 3}, LIMIT)
    assert (agreement.false_alarms, agreement.misses) == ([1], [2])
    assert (agreement.tips, agreement.within, agreement.median) == (4, 0.5, 10.5)


@pytest.mark.parametrize("joints", [{}, {0: np.full((21, 2), np.nan)}])
def test_a_hand_that_was_not_found_is_wrong_and_not_left_out(joints):
    agreement = compare({0: marks()}, joints, {0}, LIMIT)
    assert (agreement.tips, agreement.within) == (1, 0.0)
    assert np.isinf(agreement.median)


@pytest.mark.parametrize("folder", sorted(FOLDER.iterdir()), ids=lambda folder: folder.name)
def test_both_passes_mark_the_same_frames_and_agree_in_most_joints(folder):
    recording = MarkedRecording.load(folder)
    assert len(recording.marks) >= 8
    apart = recording.measure_passes()
    assert np.median(apart) < 3.0  # px
    assert np.mean(apart <= recording.limit) > 0.85


def test_frames_that_cut_the_hand_off_are_named_and_all_others_count():
    assert MarkedRecording.load(FOLDER / "d405_take001_cam0").list_whole(126) == {*range(2, 10), *range(30, 121)}
    assert MarkedRecording.load(FOLDER / "uvr_cube_white").list_whole(200) == set(range(200))


def test_a_joint_off_its_mark_or_missing_needs_a_correction_and_one_that_the_passes_do_not_share_none():
    recording = MarkedRecording.load(FOLDER / "d405_take001_cam0")
    frames = sorted(recording.marks)

    def suggest(frame: int, camera: str) -> np.ndarray:
        joints = recording.points(0, frame)
        return joints + np.array([2.0 * recording.limit, 0.0]) if frame == frames[0] else joints

    marked, wrong = count_corrections({"cam0": recording}, suggest, 0)
    assert marked.tolist() == [np.count_nonzero(np.isfinite(recording.points(0, frame)[:, 0])) for frame in frames]
    assert wrong.tolist() == [marked[0], *[0.0] * (len(frames) - 1)]
    shared, _ = count_corrections({"cam0": recording}, suggest, None)
    assert np.all(shared <= marked) and shared.sum() < marked.sum()
    _, missing = count_corrections({"cam0": recording}, lambda frame, camera: np.full((21, 2), np.nan), 0)
    np.testing.assert_array_equal(missing, marked)


@pytest.mark.parametrize("change", CHANGES, ids=lambda change: change.name)
def test_a_mark_in_a_changed_image_lies_on_the_same_pixel(change: Change):
    image = np.arange(5 * 7).reshape(5, 7)
    points = np.array([[0, 0], [6, 4], [2, 3]])
    columns, rows = change.of_points(points, 7, 5).T
    assert change.of_image(image)[rows, columns].tolist() == image[points[:, 1], points[:, 0]].tolist()
    assert change.is_mirrored == (change.name == "mirrored")


HAND = np.array([[20.0, 10.0], [40.0, 10.0], [40.0, 29.0], [20.0, 29.0]])
"""The wrist is its left side."""


def rectangle(left: int, right: int) -> np.ndarray:
    drawn = np.zeros((40, 60), dtype=bool)
    drawn[10:30, left:right] = True
    return drawn


@pytest.mark.parametrize(("drawn", "overlap"), [((20, 41), 1.0), ((0, 41), 1.0), ((20, 31), 11 / 21), ((0, 0), 0.0)])
@pytest.mark.parametrize("turn", [1, -1])
def test_a_drawn_hand_is_compared_with_an_outline_up_to_the_wrist(drawn, overlap, turn):
    outline = HAND if turn == 1 else HAND[::-1]
    assert compare_outline(rectangle(*drawn), outline) == pytest.approx(overlap)


def test_outlines_lie_in_their_images():
    paths = sorted(FOLDER.glob(f"*/{OUTLINES}"))
    assert len(paths) == 3
    for path in paths:
        for outline in json.loads(path.read_text()).values():
            assert (np.array(outline) >= 0).all() and (np.array(outline) < (640, 480)).all()
