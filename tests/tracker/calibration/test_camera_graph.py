"""Cameras stand along the pairs that agree best, and those that share no board are named."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tracker.calibration.filmed_board import BOARD, film, seen_by
from tracker.calibration.camera_graph import place_cameras, relate_all
from tracker.calibration.camera_pair import CameraPair, SeenBoards
from tracker.errors import CalibrationError
from tracker.geometry.se3 import exp


@pytest.fixture(scope="module")
def late() -> list[SeenBoards]:
    """Two cameras at 15 frames a second, the second's video four frames late."""
    return seen_by(film(2, (0.0, 4 / 15), fps=15.0, seconds=6.0), 0.1)


def test_cameras_are_placed_along_the_pairs_though_the_last_never_shares_a_board_with_the_first() -> None:
    filmed = film(4, seconds=4.0, fps=10.0)
    seen = seen_by(filmed)
    told: list[float] = []
    pairs = relate_all(BOARD, seen, 0.0, lambda what, share: told.append(share))
    assert told == sorted(told) and told[-1] == 1.0 and len(told) == 6
    chain = [pair for pair in pairs if pair.second - pair.first == 1]
    places, offsets, is_known = place_cameras(BOARD, seen, chain)
    truth = np.array([camera.T_world_camera for camera in filmed.cameras])
    assert np.linalg.norm(places[:, :3, 3] - truth[:, :3, 3], axis=1).max() < 0.02, "m"
    assert not offsets.any() and is_known[0]


def test_of_two_ways_to_a_camera_the_one_that_agrees_better_is_taken(late) -> None:
    right, wrong = exp(np.array([0.5, 0, 0, 0, 0, 0])), exp(np.array([0.9, 0, 0, 0, 0, 0]))
    pairs = [CameraPair(0, 1, wrong, 0.0, 30, 20.0, False), CameraPair(0, 1, right, 0.25, 30, 0.5, True)]
    places, offsets, is_known = place_cameras(BOARD, late, pairs)
    assert np.allclose(places[1], right) and offsets.tolist() == [0.0, 0.25] and is_known.tolist() == [True, True]


def test_cameras_that_share_no_board_or_disagree_about_it_are_named(late) -> None:
    with pytest.raises(CalibrationError, match="cam1: no board was seen at the same moment by it and by cam0"):
        place_cameras(BOARD, late, [])
    with pytest.raises(CalibrationError, match="cam1: disagrees with cam0 about where 9 boards are, by 400 px"):
        place_cameras(BOARD, late, [CameraPair(0, 1, np.eye(4), 0.0, 9, 400.0, False)])
