"""A board's pose is where the board is, and how far two poses are apart is told in pixels."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tracker.calibration.filmed_board import BOARD, film, seen_by
from tracker.calibration.board_pose import find_board_poses, measure_transfer
from tracker.calibration.camera_pair import SeenBoards
from tracker.geometry.se3 import exp


@pytest.fixture(scope="module")
def late() -> list[SeenBoards]:
    """Two cameras at 15 frames a second, the second's video four frames late."""
    return seen_by(film(2, (0.0, 4 / 15), fps=15.0, seconds=6.0), 0.1)


def test_a_boards_pose_is_where_it_is_and_four_corners_are_needed(late) -> None:
    filmed = film(2, (0.0, 4 / 15), fps=15.0, seconds=6.0)
    assert np.isfinite(late[0].poses[:, 0, 0]).mean() > 0.9
    few = np.full((1, len(BOARD.corners), 2), np.nan)
    few[0, :3] = 100.0
    assert np.isnan(find_board_poses(BOARD, late[0].lens, few)).all()
    exact = filmed.pixels_at(0, np.array([1.0]))
    (T,) = find_board_poses(BOARD, late[0].lens, exact)
    points = BOARD.corners @ T[:3, :3].T + T[:3, 3]
    assert np.nanmax(np.abs(filmed.cameras[0].project(points) - exact[0])) < 1e-3, "px"


def test_a_pose_that_is_off_is_off_by_as_many_pixels_as_its_corners_and_behind_the_camera_without_end() -> None:
    K = np.array([[500.0, 0.0, 320.0], [0.0, 500.0, 240.0], [0.0, 0.0, 1.0]])
    T = exp(np.array([0.0, 0.0, 1.0, 0.0, 0.0, 0.0]))[None]
    aside = T.copy()
    aside[:, 0, 3] += 0.01
    assert measure_transfer(BOARD, K, T, T)[0] == 0.0
    assert measure_transfer(BOARD, K, T, aside)[0] == pytest.approx(5.0), "10 mm at a metre with 500 px"
    assert measure_transfer(BOARD, K, T, -T)[0] == np.inf
