"""Each thing that is wrong with what a camera saw is said once, with its name; a sound calibration says nothing."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.tracker.calibration.filmed_board import BOARD, film
from tracker.calibration.camera_calibration import BoardResiduals, CameraCalibration, TimeOffset
from tracker.calibration.camera_faults import FilmLength, check_lengths, find_length_faults, find_warnings
from tracker.calibration.sightings import Sightings
from tracker.errors import CalibrationError

FRAMES = 90


def seen_by(camera: str, frames: int = FRAMES, reach: float = 0.9) -> Sightings:
    """Two corners at opposite ends of so much of the picture."""
    corners = np.array([[[640.0, 480.0], [640.0, 480.0]]]) * np.array([[1 - reach], [1 + reach]]) / 2
    return Sightings(camera, 640, 480, 30.0, np.arange(frames) / 30.0, np.array([0]), corners)


def calibrated(px: tuple[float, ...] = (0.2, 0.2), offset: TimeOffset | None = None, hidden: int = 0):
    """Two cameras; at the one moment that was left out each has its residual, NaN for none."""
    known = np.isfinite(px)
    residuals = BoardResiduals(
        np.flatnonzero(known), np.ones(known.sum(), int), np.array(px)[known], np.zeros((known.sum(), 2))
    )
    places = np.tile(np.eye(4), (3, 1, 1))
    places[:hidden] = np.nan
    offsets = (TimeOffset(0.0, 0.0, True), offset or TimeOffset(0.0, 0.0, True))
    is_left_out = np.array([False, True, False])
    return CameraCalibration(
        BOARD, film(2).cameras, offsets, np.arange(3.0), is_left_out, places, residuals, residuals, (), (), ()
    )


SOUND = [seen_by("left"), seen_by("right")]


def test_a_sound_calibration_says_nothing() -> None:
    assert find_warnings(calibrated(), SOUND, find_offsets=True) == []


@pytest.mark.parametrize(
    ("result", "sightings", "said"),
    [
        (calibrated(), [SOUND[0], seen_by("right", FRAMES - 5)], ("right: ", "85 frames", "3.00 s")),
        (calibrated(offset=TimeOffset(0.05, 1.5, True)), SOUND, ("right: is out of step", "1.50 frames", "later")),
        (calibrated(offset=TimeOffset(-0.05, -1.5, True)), SOUND, ("right: is out of step", "50.0 ms", "earlier")),
        (calibrated(offset=TimeOffset(0.0, 0.0, False)), SOUND, ("right: the board moved too little",)),
        (calibrated(px=(0.2, np.nan)), SOUND, ("right: no board at the moments that were left out",)),
        (calibrated(px=(1.7, 0.2)), SOUND, ("left: 1.7 px (median)", "at most 1")),
        (calibrated(), [seen_by("left", reach=0.3), SOUND[1]], ("left: the board covered only 30 %",)),
        (calibrated(hidden=1), SOUND, ("1 board could not be placed and is left out",)),
        (calibrated(hidden=2), SOUND, ("2 boards could not be placed and are left out",)),
    ],
)
def test_each_fault_alone_is_one_sentence(result, sightings, said) -> None:
    (sentence,) = find_warnings(result, sightings, find_offsets=True)
    assert all(words in sentence for words in said) and sentence[-1] in ".?"


def test_an_offset_that_nobody_looked_for_is_not_missed() -> None:
    unknown = calibrated(offset=TimeOffset(0.0, 0.0, False))
    assert find_warnings(unknown, SOUND, find_offsets=False) == []


@given(st.lists(st.integers(1, 4000), min_size=1, max_size=5), st.booleans())
def test_only_lengths_beside_the_longest_are_faults_and_each_names_its_camera(frames, find_offsets) -> None:
    lengths = [FilmLength(f"cam{number}", count, 30.0) for number, count in enumerate(frames)]
    faults = find_length_faults(lengths, find_offsets)
    limit = 0.5 * max(frames) if find_offsets else max(frames)
    assert [fault.partition(":")[0] for fault in faults] == [
        length.camera for length in lengths if length.frames < limit and (find_offsets or max(frames) > length.frames)
    ]


def test_videos_that_cannot_be_of_one_recording_are_refused() -> None:
    stopped = replace(SOUND[1], times=np.arange(20) / 30.0)
    with pytest.raises(CalibrationError, match="right: stops in the middle"):
        check_lengths([SOUND[0], stopped], find_offsets=True)
    check_lengths(SOUND, find_offsets=False)
