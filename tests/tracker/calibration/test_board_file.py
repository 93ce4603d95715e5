"""Files and words that describe boards."""

from __future__ import annotations

from pathlib import Path

import pytest

from tracker.calibration.board import Board
from tracker.calibration.board_file import MAX_BOARD_BYTES, load_board, read_board, write_board
from tracker.errors import CalibrationError

CALISCOPE = """columns = 4
rows = 5
board_height = 11.0
board_width = 8.5
dictionary = "DICT_4X4_1000"
units = "inch"
aruco_scale = 0.75
inverted = true
"""


@pytest.mark.parametrize(
    "board",
    [
        Board("charuco", 4, 5, 0.054, 0.0405, "DICT_4X4_1000", is_inverted=True),
        Board("charuco", 6, 8, 0.0213, 0.016, "DICT_6X6_250", is_legacy=True),
        Board("apriltag", 6, 6, 0.0715, 0.055, "DICT_APRILTAG_36h11"),
        Board("checkerboard", 9, 6, 0.025),
    ],
)
def test_a_board_comes_back_from_its_file(board: Board, tmp_path: Path) -> None:
    path = tmp_path / "board.toml"
    path.write_bytes(write_board(board))
    assert load_board(path) == board


def test_a_file_of_caliscope_is_read_with_its_measured_square_or_its_paper(tmp_path: Path) -> None:
    path = tmp_path / "charuco.toml"
    path.write_text(CALISCOPE + "square_size_override_cm = 5.4\n")
    board = load_board(path)
    assert (board.columns, board.rows, board.is_inverted, board.dictionary) == (4, 5, True, "DICT_4X4_1000")
    assert board.square_m == pytest.approx(0.054) and board.marker_m == pytest.approx(0.0405)
    path.write_text(CALISCOPE)
    assert load_board(path).square_m == pytest.approx(0.0254 * 8.5 / 4)


def test_a_word_describes_a_board() -> None:
    assert read_board("charuco:5x7:30:22.5:4X4_50") == Board("charuco", 5, 7, 0.03, 0.0225, "DICT_4X4_50")
    assert read_board("checkerboard:9x6:25") == Board("checkerboard", 9, 6, 0.025)
    assert read_board("apriltag:6x6:71.5:55").dictionary == "DICT_APRILTAG_36h11"


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (b"\xff\xfe\x00", "board.toml"),
        (b"columns = [" * 2000, "board.toml"),
        (b"x = 1\n" * MAX_BOARD_BYTES, f"at most {MAX_BOARD_BYTES}"),
        (b"columns = 5", "square_mm is None; needed a number above 0"),
        (b"columns = 5\nrows = 1e9\nsquare_mm = 3", "rows is 1000000000.0; needed a whole number"),
        (b"columns = true\nrows = 7\nsquare_mm = 30", "columns is True"),
        (b"columns = 5\nrows = 7\nsquare_mm = nan", "square_mm is nan"),
        (b"columns = 5\nrows = 999999999\nsquare_mm = 30", "3 to 40 squares"),
        (b"kind = 'x'\ncolumns = 5\nrows = 7\nsquare_mm = 30", "needed charuco, apriltag or checkerboard"),
        (b"columns = 5\nrows = 7\nsquare_mm = 30\ninverted = 'no'", "true or false"),
        (b"columns = 5\nrows = 7\nsquare_mm = 30\ndictionary = '__class__'", "one of OpenCV's"),
        (b"aruco_scale = 0.5\ncolumns = 0\nrows = 7\nunits = 'mile'", "units is 'mile'"),
        (b"aruco_scale = 0.5\ncolumns = 5\nrows = 7\nboard_width = 'x'", "board_width is 'x'"),
    ],
)
def test_a_hostile_file_is_refused_by_name_with_what_is_wrong(data: bytes, said: str, tmp_path: Path) -> None:
    path = tmp_path / "board.toml"
    path.write_bytes(data)
    with pytest.raises(CalibrationError) as found:
        load_board(path)
    assert said in str(found.value) and "board.toml" in str(found.value) and len(str(found.value)) < 600


@pytest.mark.parametrize("word", ["charuco:5x7", "charuco:5x7:30:99", "none.toml", "charuco:5x7:...:3", "dots:5x7:30"])
def test_a_word_that_is_no_board_is_refused(word: str) -> None:
    with pytest.raises(CalibrationError):
        read_board(word)
