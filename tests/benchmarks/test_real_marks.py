"""Joints that were found, against joints that people marked."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.real_marks.agreement import compare
from benchmarks.real_marks.marked import FOLDER, MarkedRecording

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
