"""Cameras are judged as they are: by all of them together, and by what each sees where the others put the board."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.calibration.filmed_board import BOARD
from tests.tracker.calibration.true_cameras import FILMED, TIMES, TRUTH
from tracker.calibration.arrangement import Arrangement
from tracker.calibration.judgement import judge
from tracker.geometry.se3 import exp

SEEN = FILMED.sight_all(noise_px=0.0)
LEFT_OUT = np.arange(len(TIMES)) >= 5


def judged(cameras: Arrangement = TRUTH, is_left_out: np.ndarray = LEFT_OUT, times: np.ndarray = TIMES):
    return judge(BOARD, SEEN, times, cameras, np.zeros(3), np.ones(3, dtype=bool), is_left_out)


def test_true_cameras_agree_with_everything_and_put_the_board_where_it_was() -> None:
    together, others, places = judged()
    assert together.px.max() < 0.01 and others.px.max() < 0.01, "px"
    assert np.abs(places - TRUTH.T_world_board).max() < 1e-4


def test_only_what_was_left_out_is_judged_by_the_other_cameras() -> None:
    together, others, _ = judged()
    assert set(others.moment) == {5, 6, 7} and set(together.moment) == set(range(8))
    assert set(others.camera) == {0, 1, 2}
    left_out = together.choose(LEFT_OUT[together.moment])
    order = np.lexsort((left_out.pixels[:, 0], left_out.moment, left_out.camera))
    same = np.lexsort((others.pixels[:, 0], others.moment, others.camera))
    assert np.array_equal(left_out.pixels[order], others.pixels[same]), (
        "each corner once, by cameras other than its own"
    )


def test_a_knocked_camera_is_off_where_the_others_put_the_board_and_stays_as_it_is() -> None:
    moved = TRUTH.T_camera_world.copy()
    moved[2] = exp(np.array([0.02, 0.0, 0.0, 0.0, 0.0, 0.0])) @ moved[2]
    knocked = replace(TRUTH, T_camera_world=moved)
    before = moved.copy()
    together, others, _ = judged(knocked)
    own = {number: np.median(others.px[others.camera == number]) for number in range(3)}
    focal = TRUTH.K[2, 0, 0]
    assert own[2] == pytest.approx(0.02 * focal, rel=0.25), "20 mm at about a metre"
    assert own[2] > 1.5 * max(own[0], own[1])
    assert np.median(together.px[together.camera == 2]) < own[2], "its own corners pull the board its way"
    assert np.array_equal(moved, before)


def test_when_nothing_was_left_out_nothing_is_judged_by_others() -> None:
    together, others, _ = judged(is_left_out=np.zeros(8, dtype=bool))
    assert len(together.px) > 0 and np.isnan(others.rms)
    assert len(others.camera) == len(others.moment) == len(others.px) == 0 and others.pixels.shape == (0, 2)


def test_at_a_moment_that_no_camera_filmed_the_board_has_no_place_and_no_residual() -> None:
    times = np.append(TIMES, 99.0)
    together, others, places = judged(is_left_out=np.append(LEFT_OUT, True), times=times)
    assert np.isnan(places[8]).all() and np.isfinite(places[:8]).all()
    assert 8 not in together.moment and 8 not in others.moment


def test_offsets_of_the_start_are_not_counted_twice() -> None:
    late = replace(TRUTH, offsets=np.array([0.0, 0.05, -0.05]))
    assert judged(late)[0].px.max() < 0.01, "corners are read in each camera's own time already"
