"""Boards."""

from __future__ import annotations

import numpy as np
import pytest

from tracker.calibration.board import APRILTAG, Board
from tracker.errors import CalibrationError


def test_corners_lie_where_opencv_has_them() -> None:
    board = Board("charuco", 5, 7, 0.03, 0.02, "DICT_5X5_100")
    assert np.allclose(board.corners, board.layout.getChessboardCorners(), atol=1e-7)
    assert board.size_m == pytest.approx((0.15, 0.21))
    assert "ChArUco 5x7, squares of 30 mm, markers of 20 mm" in board.describe()


def test_a_grid_of_tags_has_four_corners_for_each_tag_and_ends_with_a_tag() -> None:
    board = Board("apriltag", 3, 2, 0.05, 0.04, APRILTAG)
    assert board.corners.shape == (24, 3) and board.marker_count == 6
    assert np.allclose(board.corners[:4], [[0, 0, 0], [0.04, 0, 0], [0.04, 0.04, 0], [0, 0.04, 0]])
    assert board.size_m == pytest.approx((0.14, 0.09))


def test_a_board_looks_for_its_own_markers_only() -> None:
    assert len(Board("charuco", 4, 5, 0.054, 0.0405, "DICT_4X4_1000").markers.bytesList) == 10


@pytest.mark.parametrize(
    ("values", "said"),
    [
        (("charuco", 2, 7, 0.03, 0.02, "DICT_5X5_100"), "3 to 40 squares"),
        (("charuco", 5, 400, 0.03, 0.02, "DICT_5X5_100"), "3 to 40 squares"),
        (("charuco", 5, 7, 3.0, 0.02, "DICT_5X5_100"), "needed 1 to 1000 mm"),
        (("charuco", 5, 7, 0.03, 0.03, "DICT_5X5_100"), "less than the 30 mm"),
        (("charuco", 5, 7, 0.03, 0.02, "DICT_9X9"), "one of OpenCV's"),
        (("charuco", 5, 7, 0.03, 0.02, "Dictionary"), "one of OpenCV's"),
        (("charuco", 20, 20, 0.03, 0.02, "DICT_5X5_50"), "200 markers, DICT_5X5_50 only 50"),
        (("checkerboard", 8, 6, 0.03), "turned by 180 degrees"),
        (("dots", 8, 6, 0.03), "of the kind 'dots'"),
    ],
)
def test_an_impossible_board_is_refused_with_what_to_do(values: tuple, said: str) -> None:
    with pytest.raises(CalibrationError, match=said):
        Board(*values)
