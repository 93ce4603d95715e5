"""Moments of a calibration: none is missed, whole seconds are left out together, and what is chosen covers the most."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.tracker.calibration.filmed_board import BOARD, film
from tracker.calibration.arrangement import Corners
from tracker.calibration.moments import BLOCK_S, choose_moments, count_cameras, leave_out, list_moments, read_corners
from tracker.calibration.sightings import Sightings


def filmed(fps: float, frames: int, camera: str = "cam0") -> Sightings:
    return Sightings(camera, 640, 480, fps, np.arange(frames) / fps, np.zeros(0, np.int64), np.zeros((0, 3, 2)))


def corners_at(places: list[tuple[int, int, float, float]]) -> Corners:
    """Corners by camera, moment, column and row of pictures of 80 x 80 px."""
    camera, moment, x, y = (np.array(column) for column in zip(*sorted(places), strict=True))
    pixels = np.column_stack([x, y]).astype(np.float64)
    return Corners(camera, moment, np.zeros((len(x), 3)), pixels, np.zeros_like(pixels))


@settings(deadline=None)
@given(st.sampled_from((15.0, 25.0, 30.0)), st.integers(2, 90), st.integers(2, 90), st.integers(-60, 60))
def test_moments_are_the_first_cameras_frames_and_reach_as_far_as_any_video(fps, ours, theirs, late) -> None:
    offsets = np.array([0.0, late / fps])
    moments = list_moments([filmed(fps, ours), filmed(fps, theirs, "cam1")], offsets)
    assert np.allclose(np.diff(moments), 1.0 / fps)
    assert set(np.round(np.arange(ours)).astype(int)) <= set(np.round(moments * fps).astype(int))
    assert np.isclose(moments[0], min(0.0, -late / fps)), "the other's first frame"
    assert np.isclose(moments[-1], max(ours - 1, theirs - 1 - late) / fps)


@settings(deadline=None)
@given(st.floats(0.05, 0.5), st.integers(8, 20), st.sampled_from((10.0, 30.0)))
def test_about_the_share_asked_for_is_left_out_in_runs_and_never_all(share, rounds, fps) -> None:
    moments = np.arange(int(fps * rounds * BLOCK_S / share)) / fps
    is_out = leave_out(moments, share)
    assert abs(is_out.mean() - 1.0 / max(2, round(1.0 / share))) < 0.1
    runs = np.diff(np.flatnonzero(np.diff(np.concatenate([[False], is_out, [False]]).astype(int))))[::2]
    assert runs[:-1].min() >= BLOCK_S * fps - 1, "frames"


def test_nothing_is_left_out_when_nothing_is_asked_and_even_a_short_film_is_judged() -> None:
    assert not leave_out(np.arange(90) / 30.0, 0.0).any() and len(leave_out(np.zeros(0), 0.2)) == 0
    short = leave_out(np.arange(30) / 30.0, 0.25)
    assert 0.1 < short.mean() < 0.4


def test_cameras_are_counted_once_a_moment_however_many_corners_they_saw() -> None:
    corners = corners_at([(0, 0, 1, 1), (0, 0, 2, 2), (1, 0, 3, 3), (1, 2, 4, 4)])
    assert count_cameras(corners, 4, 2).tolist() == [2, 0, 1, 0]


def test_moments_of_two_cameras_come_before_those_of_one_and_new_places_before_known_ones() -> None:
    shared = [(camera, moment, x, 10.0) for moment, x in ((3, 5.0), (4, 5.0), (5, 75.0)) for camera in (0, 1)]
    alone = [(0, moment, 40.0, 40.0) for moment in (0, 1)]
    sizes, allowed = np.full((2, 2), 80.0), np.ones(6, dtype=bool)
    assert choose_moments(corners_at(shared + alone), sizes, allowed, 2).tolist() == [3, 5], "4 shows what 3 shows"
    assert choose_moments(corners_at(shared + alone), sizes, allowed, 4).tolist() == [0, 3, 4, 5]


@settings(deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(0, 12))
def test_only_allowed_moments_with_a_board_are_chosen_each_once_and_no_more_than_asked(seed, most) -> None:
    rng = np.random.default_rng(seed)
    corners = corners_at([(int(rng.integers(2)), int(rng.integers(10)), *rng.uniform(0, 80, 2)) for _ in range(12)])
    allowed = rng.random(10) < 0.6
    chosen = choose_moments(corners, np.full((2, 2), 80.0), allowed, most)
    possible = np.intersect1d(np.flatnonzero(allowed), corners.moment)
    assert len(chosen) == min(most, len(possible)) and np.isin(chosen, possible).all()
    assert (np.diff(chosen) > 0).all()


@pytest.mark.parametrize("late_s", [0.0, 0.1])
def test_corners_of_a_moment_are_those_that_the_board_has_there_in_each_cameras_own_time(late_s) -> None:
    cameras = film(2, (0.0, late_s), seconds=3.0)
    moments = np.arange(30, 50) / 30.0
    sightings = cameras.sight_all(noise_px=0.0)
    corners = read_corners(BOARD, sightings, moments, cameras.offsets, np.array([True, True]))
    assert set(corners.camera) == {0, 1}
    for number in (0, 1):
        own = corners.choose(corners.camera == number)
        truth = cameras.pixels_at(number, moments + cameras.offsets[number])
        index = [int(np.flatnonzero((point == BOARD.corners).all(axis=1))[0]) for point in own.points]
        assert np.abs(own.pixels - truth[own.moment, index]).max() < 0.05, "px"
