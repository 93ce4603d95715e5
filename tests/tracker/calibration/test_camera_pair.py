"""Two cameras and the time between their videos come out of what both saw; all of them stand where they stood."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tracker.calibration.filmed_board import BOARD, Filmed, film
from tracker.calibration.board_pose import find_board_poses, measure_transfer
from tracker.calibration.camera_graph import place_cameras, relate_all
from tracker.calibration.camera_pair import MIN_SHARED, CameraPair, SeenBoards, relate_cameras
from tracker.calibration.lens import Lens
from tracker.calibration.sightings import Sightings
from tracker.errors import CalibrationError
from tracker.geometry.se3 import exp, inverse


def seen_by(filmed: Filmed, noise_px: float = 0.0) -> list[SeenBoards]:
    """What every camera saw, with the board's pose in each frame."""
    lenses = [Lens(camera.K, camera.distortion) for camera in filmed.cameras]
    return [
        SeenBoards(seen, lens, find_board_poses(filmed.board, lens, seen.corners))
        for seen, lens in zip(filmed.sight_all(noise_px=noise_px), lenses, strict=True)
    ]


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
