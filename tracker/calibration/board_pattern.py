"""What is dark on a board, as rectangles: for the printed sheet, and to draw boards into pictures."""

from __future__ import annotations

import cv2
import numpy as np
import numpy.typing as npt

from tracker.calibration.board import Board

Array = npt.NDArray[np.float64]


def find_dark_rectangles(board: Board) -> Array:
    """(M, 4) board, m: x, y, width, height of what is drawn on the ground; black on white, inverted white on black."""
    side = board.square_m
    rectangles: list[tuple[float, float, float, float]] = []
    has_marker = np.zeros((board.rows, board.columns), dtype=bool)
    if board.kind != "checkerboard":
        for points, number in zip(board.layout.getObjPoints(), np.ravel(board.layout.getIds()), strict=True):
            x, y = (float(value) for value in np.min(points, axis=0)[:2])
            has_marker[int(y // side), int(x // side)] = True
            rectangles += _draw_marker(board, int(number), x, y)
    if board.kind == "apriltag":
        return np.array(rectangles)
    if board.kind == "checkerboard":
        has_marker = np.indices(has_marker.shape).sum(axis=0) % 2 == 1
    rectangles += [(column * side, row * side, side, side) for row, column in np.argwhere(~has_marker)]
    return np.array(rectangles)


def draw_board(board: Board, pixels_per_m: float, margin_px: int = 0) -> npt.NDArray[np.uint8]:
    """The board as a grey image (H, W), straight from the front, `margin_px` of ground around it."""
    width, height = (round(length * pixels_per_m) + 2 * margin_px for length in board.size_m)
    ground, ink = (0, 255) if board.is_inverted else (255, 0)
    image = np.full((height, width), ground, dtype=np.uint8)
    for x, y, w, h in find_dark_rectangles(board):
        left, right = (margin_px + round(value * pixels_per_m) for value in (x, x + w))
        top, bottom = (margin_px + round(value * pixels_per_m) for value in (y, y + h))
        image[top:bottom, left:right] = ink
    return image


def _draw_marker(board: Board, number: int, x: float, y: float) -> list[tuple[float, float, float, float]]:
    """A marker's dark runs, row by row; its border is one cell wide."""
    cells = board.markers.markerSize + 2
    bits = cv2.aruco.generateImageMarker(board.markers, number, cells) == 0
    cell = board.marker_m / cells
    runs = []
    for row, line in enumerate(bits):
        edges = np.flatnonzero(np.diff(np.concatenate([[0], line.astype(np.int8), [0]])))
        runs += [
            (x + first * cell, y + row * cell, (last - first) * cell, cell)
            for first, last in zip(edges[::2], edges[1::2], strict=True)
        ]
    return runs
