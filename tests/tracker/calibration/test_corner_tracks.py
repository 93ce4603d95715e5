"""Corners between frames."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tracker.calibration.filmed_board import film
from tracker.calibration.corner_tracks import find_corners_at
from tracker.calibration.sightings import Sightings


def make_sightings(frames: list[int], values: np.ndarray, count: int) -> Sightings:
    return Sightings("cam", 100, 100, 10.0, np.arange(count) / 10.0, np.array(frames), values)


def test_at_a_frame_the_corners_are_those_of_the_frame(rng: np.random.Generator) -> None:
    values = rng.normal(size=(8, 3, 2))
    pixels, _ = find_corners_at(make_sightings(list(range(8)), values, 8), np.arange(8) / 10.0)
    assert np.array_equal(pixels, values)


def test_between_frames_a_smooth_motion_is_met_far_better_than_by_a_straight_line() -> None:
    filmed = film(2, seconds=4.0, fps=15.0)
    seen = filmed.sight(0, np.random.default_rng(0), noise_px=0.0)
    times = (np.arange(5, 50) + 0.37) / 15.0
    truth = filmed.pixels_at(0, times)
    pixels, speed = find_corners_at(seen, times)
    straight = seen.corners[5:50] + 0.37 * (seen.corners[6:51] - seen.corners[5:50])
    assert np.nanmax(np.abs(pixels - truth)) < 0.1
    assert np.nanmax(np.abs(pixels - truth)) < 0.25 * np.nanmax(np.abs(straight - truth))
    later, _ = find_corners_at(seen, times + 1e-5)
    assert np.allclose((later - pixels) / 1e-5, speed, atol=0.05)  # the velocity is the derivative


def test_what_one_of_two_frames_lacks_is_not_made_up_between_them() -> None:
    values = np.arange(12.0).reshape(3, 2, 2)
    values[1, 0] = np.nan
    seen = make_sightings([0, 1, 3], values, 5)
    pixels, speed = find_corners_at(seen, np.array([0.0, 0.05, 0.15, 0.3, 0.35, 9.0, -1.0]))
    is_known = np.isfinite(pixels[..., 0])
    assert is_known.tolist() == [[1, 1], [0, 1], [0, 0], [1, 1], [0, 0], [0, 0], [0, 0]]
    assert np.isfinite(speed).all()


@pytest.mark.parametrize("moment", [0.26, 0.34])
def test_frozen_corners_are_those_of_the_nearest_frame(moment: float) -> None:
    values = np.arange(20.0).reshape(5, 2, 2)
    pixels, speed = find_corners_at(make_sightings([0, 1, 2, 3, 4], values, 5), np.array([moment]), frozen=True)
    assert np.array_equal(pixels[0], values[3]) and not speed.any()
