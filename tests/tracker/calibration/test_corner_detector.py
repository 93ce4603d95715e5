"""Corners in pictures."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tracker.calibration.filmed_board import BOARD, film
from tracker.calibration.board import APRILTAG, Board
from tracker.calibration.board_pattern import draw_board
from tracker.calibration.corner_detector import CornerDetector, drop_misnumbered

CHECKERBOARD = Board("checkerboard", 8, 5, 0.035)
TAGS = Board("apriltag", 5, 4, 0.055, 0.042, APRILTAG)


@pytest.mark.parametrize("board", [BOARD, CHECKERBOARD, TAGS], ids=lambda board: board.kind)
def test_the_corners_of_a_rendered_board_are_found_to_a_fraction_of_a_pixel(board: Board) -> None:
    filmed = film(2, seconds=6.0, fps=2.0, board=board, size=(960, 540))
    detector = CornerDetector(board)
    apart = []
    for number in range(2):
        truth = filmed.pixels(number)
        for frame in range(0, 12, 3):
            if np.isfinite(truth[frame]).all():
                apart.append(np.linalg.norm(detector.find(filmed.render(number, frame)) - truth[frame], axis=1))
    assert len(apart) >= 3
    found = np.concatenate(apart)
    assert np.isfinite(found).mean() > 0.7
    assert np.nanmedian(found) < (0.35 if board is TAGS else 0.15) and np.nanmax(found) < (
        3.0 if board is TAGS else 1.0
    )


@pytest.mark.parametrize("turns", [0, 1, 2, 3])
def test_a_checkerboard_is_numbered_alike_whichever_way_it_is_turned(turns: int) -> None:
    upright = draw_board(CHECKERBOARD, 2000.0, margin_px=60)
    found = CornerDetector(CHECKERBOARD).find(np.ascontiguousarray(np.rot90(upright, turns)))
    height, width = upright.shape
    expected = CHECKERBOARD.corners[:, :2] * 2000.0 + 60 - 0.5
    for _ in range(turns):
        expected = np.stack([expected[:, 1], width - 1 - expected[:, 0]], axis=1)
        width, height = height, width
    assert np.abs(found - expected).max() < 0.7


def test_nothing_is_found_in_noise(rng: np.random.Generator) -> None:
    noise = rng.integers(0, 255, (240, 320), dtype=np.uint8)
    for board in (BOARD, CHECKERBOARD, TAGS):
        assert not np.isfinite(CornerDetector(board).find(noise)).any()


def test_a_corner_with_a_wrong_number_is_left_out_and_a_line_of_corners_is_no_board() -> None:
    truth = film(2).pixels(0)[0]
    wrong = truth.copy()
    wrong[3] += 80.0
    kept = drop_misnumbered(BOARD, wrong)
    assert np.isnan(kept[3]).all() and np.isfinite(np.delete(kept, 3, axis=0)).all()
    line = np.full_like(truth, np.nan)
    line[:6] = truth[:6]
    assert np.isnan(drop_misnumbered(BOARD, line)).all()
