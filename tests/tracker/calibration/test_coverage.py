"""The picture of where a board was seen: a dot for each corner in the colour of its residual, grey where none was."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest

from tests.tracker.calibration.found_calibration import found_calibration
from tracker.calibration.camera_calibration import BoardResiduals
from tracker.calibration.coverage import LEVELS, PICTURE_WIDTH, draw_coverage, encode_coverage

FOUND = found_calibration()
EMPTY = (232, 232, 232)
MIDDLE = np.array([[640.0, 360.0]])


def seen(px: float, moment: int = 0, pixels: np.ndarray = MIDDLE):
    """One corner, of the first camera."""
    one = BoardResiduals(np.array([0]), np.array([moment]), np.array([px]), pixels)
    return replace(FOUND, residuals=one)


@pytest.mark.parametrize(
    ("px", "level"), [(0.0, 0), (0.5, 0), (0.5001, 1), (1.0, 1), (1.5, 2), (2.0, 2), (2.001, 3), (900.0, 3)]
)
def test_a_corner_has_the_colour_of_the_first_level_that_its_residual_does_not_exceed(px: float, level: int) -> None:
    assert tuple(draw_coverage(seen(px), 0)[270, 480]) == LEVELS[level][1]


def test_only_a_corner_that_was_left_out_has_a_ring() -> None:
    fitted, left_out = draw_coverage(seen(0.2), 0), draw_coverage(seen(0.2, moment=2), 0)
    changed = np.argwhere((fitted != left_out).any(axis=2))
    assert len(changed) > 10
    assert (np.abs(np.linalg.norm(changed - [270, 480], axis=1) - 5) < 2).all()


def test_a_camera_shows_its_own_corners_alone() -> None:
    (first, second), other = (draw_coverage(FOUND, number) for number in (0, 1)), draw_coverage(seen(0.3), 1)
    assert tuple(first[75, 75]) == LEVELS[0][1] and tuple(second[450, 150]) == LEVELS[3][1]
    assert tuple(second[75, 75]) != LEVELS[0][1]
    assert (other[:540] == EMPTY).all(axis=2).mean() > 0.9, "it saw nothing"


def test_a_corner_fills_one_cell_of_the_eight_along_the_longer_side() -> None:
    nothing = replace(FOUND, residuals=FOUND.residuals.choose(np.zeros(5, dtype=bool)))
    cell = (slice(122, 238), slice(362, 478))  # 120 px wide; without its border
    at = np.array([[420.0, 180.0]]) / 0.75
    empty, filled = draw_coverage(nothing, 0), draw_coverage(seen(0.1, pixels=at), 0)
    assert (empty[cell] == EMPTY).all(axis=2).mean() > 0.9 and not (filled[cell] == EMPTY).all(axis=2).any()
    elsewhere = np.ones(empty.shape[:2], dtype=bool)
    elsewhere[118:242, 358:482] = False  # a line across it ends in its corners
    elsewhere[540:] = False
    assert np.array_equal(empty[elsewhere], filled[elsewhere])


def test_a_corner_on_the_line_between_cells_counts_for_the_right_one_alone() -> None:
    at = np.array([[480.0, 180.0]]) / 0.75
    image = draw_coverage(seen(0.1, pixels=at), 0)
    assert tuple(image[130, 380]) == EMPTY and tuple(image[130, 500]) == (255, 255, 255)


@pytest.mark.parametrize(
    ("width", "height", "rows"), [(1280, 720, 540), (720, 1280, 1707), (4000, 8, 2), (500, 500, 960)]
)
def test_the_picture_has_the_cameras_shape_above_a_legend(width: int, height: int, rows: int) -> None:
    camera = replace(FOUND.cameras[0], width=width, height=height)
    image = draw_coverage(replace(FOUND, cameras=(camera, FOUND.cameras[1])), 0)
    assert image.shape == (rows + 40, PICTURE_WIDTH, 3)
    legend = image[rows + 1 :].reshape(-1, 3)
    for _, color in LEVELS:
        assert (legend == color).all(axis=1).any()


def test_the_png_is_the_picture() -> None:
    data = encode_coverage(FOUND, 0)
    decoded = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR)
    assert data.startswith(b"\x89PNG") and decoded is not None
    assert np.array_equal(decoded, draw_coverage(FOUND, 0))
