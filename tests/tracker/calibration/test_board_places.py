"""Boards are placed by the camera whose answer suits all of them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tests.tracker.calibration.filmed_board import BOARD
from tests.tracker.calibration.true_cameras import CORNERS, TIMES, TRUTH
from tracker.calibration.board_places import find_board_places


def test_each_board_is_placed_by_the_camera_whose_answer_suits_all_and_without_corners_not_at_all() -> None:
    places = find_board_places(BOARD, TRUTH, CORNERS, len(TIMES) + 1)
    assert np.abs(places[:-1] - TRUTH.T_world_board).max() < 1e-4 and np.isnan(places[-1]).all()
    spoilt = CORNERS.pixels.copy()
    own = CORNERS.camera == 1
    spoilt[own] += np.random.default_rng(0).normal(0, 8.0, (own.sum(), 2))
    other = find_board_places(BOARD, TRUTH, replace(CORNERS, pixels=spoilt), len(TIMES))
    assert np.abs(other - TRUTH.T_world_board).max() < 1e-3, "the sharp cameras decide"
