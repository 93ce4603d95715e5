"""What is dark on a board: no rectangle over another, nothing beyond the sheet, the ground where nothing is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tracker.calibration.board import APRILTAG, Board
from tracker.calibration.board_pattern import draw_board, find_dark_rectangles

CHARUCO = Board("charuco", 5, 4, 0.04, 0.03, "DICT_5X5_100")
TAGS = Board("apriltag", 3, 2, 0.05, 0.04, APRILTAG)
CHECKERS = Board("checkerboard", 4, 3, 0.03)
BOARDS = pytest.mark.parametrize("board", [CHARUCO, TAGS, CHECKERS], ids=lambda board: board.kind)


@BOARDS
def test_rectangles_lie_on_the_board_and_never_over_each_other(board: Board) -> None:
    x, y, width, height = find_dark_rectangles(board).T
    assert (width > 0).all() and (height > 0).all() and min(x.min(), y.min()) > -1e-9
    assert (x + width).max() < board.size_m[0] + 1e-9 and (y + height).max() < board.size_m[1] + 1e-9
    across = np.minimum.outer(x + width, x + width) - np.maximum.outer(x, x)
    down = np.minimum.outer(y + height, y + height) - np.maximum.outer(y, y)
    common = np.clip(across, 0, None) * np.clip(down, 0, None)
    assert np.allclose(common - np.diag(width * height), 0, atol=1e-12), "m²"


def test_a_checkerboard_begins_dark_and_every_second_square_is() -> None:
    rectangles = find_dark_rectangles(CHECKERS)
    squares = np.rint(rectangles[:, :2] / 0.03).astype(int).tolist()
    assert sorted(squares) == [[0, 0], [0, 2], [1, 1], [2, 0], [2, 2], [3, 1]]
    assert np.allclose(rectangles[:, 2:], 0.03)


def test_a_charuco_is_dark_where_no_marker_is_and_markers_stay_in_the_middle_of_their_squares() -> None:
    rectangles = find_dark_rectangles(CHARUCO)
    is_square = np.isclose(rectangles[:, 3], 0.04)
    assert is_square.sum() == 20 - CHARUCO.marker_count
    squares = np.rint(rectangles[is_square, :2] / 0.04).astype(int)
    assert (squares.sum(axis=1) % 2 == 0).all(), "the first square is dark"
    runs = rectangles[~is_square]
    within = runs[:, :2] % 0.04
    assert within.min() > 0.005 - 1e-6 and (within + runs[:, 2:]).max() < 0.035 + 1e-6, "m"


@pytest.mark.parametrize("board", [CHARUCO, TAGS], ids=lambda board: board.kind)
def test_every_tag_and_marker_has_an_unbroken_border_of_one_cell(board: Board) -> None:
    image = draw_board(board, 8000.0)
    cell = board.marker_m / (board.markers.markerSize + 2)
    for corners in board.layout.getObjPoints():
        left, top = np.min(corners, axis=0)[:2]
        near, far = 0.5 * cell, board.marker_m - 0.5 * cell
        along = np.linspace(near, far, 30)
        ring = [(a, b) for a in along for b in (near, far)] + [(b, a) for a in along for b in (near, far)]
        pixels = np.rint((np.array(ring) + np.array([left, top])) * 8000.0).astype(int)
        assert (image[pixels[:, 1], pixels[:, 0]] == 0).all()


@BOARDS
def test_an_inverted_board_has_black_and_white_exchanged_its_margin_too(board: Board) -> None:
    plain, inverted = (draw_board(replace(board, is_inverted=way), 1000.0, margin_px=7) for way in (False, True))
    assert np.array_equal(255 - plain, inverted) and set(np.unique(plain)) == {0, 255}


@pytest.mark.parametrize("margin", [0, 12])
def test_the_picture_has_the_boards_size_with_a_margin_of_ground_on_every_side(margin: int) -> None:
    bare, image = draw_board(TAGS, 2000.0), draw_board(TAGS, 2000.0, margin_px=margin)
    assert bare.shape == (180, 280) and image.shape == (180 + 2 * margin, 280 + 2 * margin)
    assert np.array_equal(image, np.pad(bare, margin, constant_values=255))


def test_a_legacy_board_with_an_even_number_of_rows_begins_in_white() -> None:
    board = Board("charuco", 5, 4, 0.04, 0.03, "DICT_5X5_100", is_legacy=True)
    old, new = draw_board(board, 1000.0), draw_board(CHARUCO, 1000.0)
    assert old[2, 2] == 255 and new[2, 2] == 0
