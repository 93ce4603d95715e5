"""The printed sheet: drawn from the PDF itself, the board is found on it at its true size."""

from __future__ import annotations

import re

import cv2
import numpy as np
import pytest

from tracker.calibration.board import APRILTAG, Board
from tracker.calibration.board_pattern import draw_board
from tracker.calibration.board_pdf import MARGIN_M, POINTS_PER_M, make_board_pdf
from tracker.calibration.corner_detector import CornerDetector

BOARDS = [
    Board("charuco", 5, 7, 0.03, 0.0225, "DICT_5X5_100"),
    Board("charuco", 4, 6, 0.03, 0.0225, "DICT_4X4_50", is_legacy=True),
    Board("charuco", 4, 5, 0.054, 0.0405, "DICT_4X4_1000", is_inverted=True),
    Board("apriltag", 4, 3, 0.05, 0.04, APRILTAG),
    Board("checkerboard", 9, 6, 0.025),
]
DOTS_PER_POINT = 4


def draw_pdf(data: bytes) -> np.ndarray:
    """The page as a grey image: its filled rectangles, nothing else."""
    width, height = (float(v) for v in re.search(rb"MediaBox \[0 0 ([\d.]+) ([\d.]+)\]", data).groups())  # type: ignore[union-attr]
    image = np.full((round(height * DOTS_PER_POINT), round(width * DOTS_PER_POINT)), 255, np.uint8)
    content = re.search(rb"stream\n(.*)\nendstream", data, re.DOTALL)[1].decode()  # type: ignore[index]
    shade, waiting = 0, []
    for line in content.splitlines():
        words = line.split()
        if words[-1] == "g":
            shade = round(255 * float(words[0]))
        elif words[-1] == "re":
            waiting.append([float(word) * DOTS_PER_POINT for word in words[:4]])
        elif words[-1] == "f":
            for x, y, w, h in waiting:
                top = image.shape[0] - (y + h)
                image[round(top) : round(top + h), round(x) : round(x + w)] = shade
            waiting = []
    return image


@pytest.mark.parametrize("board", BOARDS, ids=lambda board: f"{board.kind}-{board.columns}x{board.rows}")
def test_a_printed_board_is_found_and_every_corner_is_where_it_should_be_on_paper(board: Board) -> None:
    image = draw_pdf(make_board_pdf(board))
    found = CornerDetector(board).find(image)
    paper_m = (found + 0.5) / DOTS_PER_POINT / POINTS_PER_M - MARGIN_M
    assert np.abs(paper_m - board.corners[:, :2]).max() < 0.0001


@pytest.mark.parametrize(
    "board",
    [board for board in BOARDS if board.kind != "checkerboard"],  # OpenCV draws none of these
    ids=lambda board: f"{board.kind}-{board.columns}x{board.rows}",
)
def test_a_drawn_board_is_what_opencv_draws(board: Board) -> None:
    ours = draw_board(board, 4000.0)
    theirs = board.layout.generateImage((ours.shape[1], ours.shape[0]), marginSize=0, borderBits=1)
    theirs = cv2.bitwise_not(theirs) if board.is_inverted else theirs
    assert np.mean(ours != theirs) < 0.02  # edges fall between pixels here and there


def test_the_page_is_a_whole_pdf() -> None:
    data = make_board_pdf(BOARDS[0])
    assert data.startswith(b"%PDF-1.4") and data.endswith(b"%%EOF\n")
    start = int(re.search(rb"startxref\n(\d+)", data)[1])  # type: ignore[index]
    assert data[start:].startswith(b"xref\n0 6\n")
    for number, place in enumerate(re.findall(rb"(\d{10}) 00000 n", data), 1):
        assert data[int(place) :].startswith(b"%d 0 obj" % number)
    length = int(re.search(rb"/Length (\d+)", data)[1])  # type: ignore[index]
    assert data[data.index(b"stream\n") + 7 :][length:].startswith(b"\nendstream")
    assert rb"\(DICT_5X5_100\)" in data and b"100 mm long" in data
