"""Two cameras and the time between their videos come out of what both saw; all of them stand where they stood."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tracker.calibration.filmed_board import BOARD, film, seen_by
from tracker.calibration.camera_pair import MIN_SHARED, SeenBoards, relate_cameras
from tracker.calibration.sightings import Sightings
from tracker.geometry.se3 import inverse


@pytest.fixture(scope="module")
def late() -> list[SeenBoards]:
    """Two cameras at 15 frames a second, the second's video four frames late."""
    return seen_by(film(2, (0.0, 4 / 15), fps=15.0, seconds=6.0), 0.1)


def test_a_pair_finds_the_offset_to_the_frame_and_where_the_other_camera_is(late) -> None:
    pair = relate_cameras((0, 1), BOARD, *late, max_offset_s=0.5)
    assert pair is not None and pair.is_telling
    assert pair.offset_s == pytest.approx(4 / 15, abs=1e-9) and pair.error_px < 3.0
    truth = film(2).cameras[1].T_world_camera
    assert np.linalg.norm(pair.T_first_second[:3, 3] - truth[:3, 3]) < 0.01, "m"


def test_the_pair_the_other_way_round_is_the_inverse(late) -> None:
    pair, back = (relate_cameras((0, 1), BOARD, *order, max_offset_s=0.5) for order in (late, late[::-1]))
    assert pair is not None and back is not None
    assert back.offset_s == pytest.approx(-pair.offset_s)
    assert np.allclose(back.T_first_second, inverse(pair.T_first_second), atol=0.02)


def test_an_offset_out_of_reach_is_not_found_and_too_few_shared_boards_make_no_pair(late) -> None:
    near = relate_cameras((0, 1), BOARD, *late, max_offset_s=0.1)
    assert near is None or abs(near.offset_s) <= 0.1
    seen = late[1].sightings
    few = slice(0, MIN_SHARED - 1)
    rare = Sightings(seen.camera, seen.width, seen.height, seen.fps, seen.times, seen.frames[few], seen.corners[few])
    other = SeenBoards(rare, late[1].lens, late[1].poses[few])
    assert relate_cameras((0, 1), BOARD, late[0], other, max_offset_s=0.5) is None
