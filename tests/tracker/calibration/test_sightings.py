"""Where a camera saw the board; where it did not, why."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest

from tracker.calibration.board import APRILTAG, Board
from tracker.calibration.board_pattern import draw_board
from tracker.calibration.camera_source import CameraSource
from tracker.calibration.sightings import MIN_SIGHTINGS, explain_absence, find_sightings
from tracker.errors import CalibrationError

BOARD = Board("charuco", 5, 4, 0.04, 0.03, "DICT_5X5_100")
PER_M, MARGIN = 1500.0, 40
PICTURE = draw_board(BOARD, PER_M, MARGIN)
BLANK = np.full_like(PICTURE, 128)


def film(folder: Path, images: list[np.ndarray], fps: float = 10.0) -> CameraSource:
    folder.mkdir(exist_ok=True)
    names = tuple(f"{number}.png" for number in range(len(images)))
    for name, image in zip(names, images, strict=True):
        cv2.imwrite(str(folder / name), image)
    return CameraSource("left", folder, names, fps, len(images))


def test_the_frames_with_the_board_are_named_with_its_corners_and_their_times(tmp_path: Path) -> None:
    shown = [False, True, True, False, True, True, True]
    told: list[tuple[str, float]] = []
    source = film(tmp_path, [PICTURE if is_there else BLANK for is_there in shown])
    seen = find_sightings(source, BOARD, lambda what, share: told.append((what, share)))
    assert (seen.camera, seen.width, seen.height, seen.fps) == ("left", PICTURE.shape[1], PICTURE.shape[0], 10.0)
    assert seen.frames.tolist() == np.flatnonzero(shown).tolist() and len(seen.times) == 7
    assert seen.seen_at == pytest.approx([0.1, 0.2, 0.4, 0.5, 0.6])
    expected = BOARD.corners[:, :2] * PER_M + MARGIN - 0.5
    assert np.abs(seen.corners - expected).max() < 0.5, "px"
    assert told == [("looking for the board in left", pytest.approx((n + 1) / 7)) for n in range(7)]


@pytest.mark.parametrize("count", [0, MIN_SIGHTINGS - 1])
def test_too_few_sightings_are_refused_with_their_number(tmp_path: Path, count: int) -> None:
    source = film(tmp_path, [PICTURE] * count + [BLANK] * (6 - count))
    with pytest.raises(
        CalibrationError, match=rf"^left: the board \(ChArUco 5x4.*found in {count} of 6 frames; needed at least 4\."
    ):
        find_sightings(source, BOARD)
    assert len(find_sightings(film(tmp_path, [PICTURE] * 4), BOARD).frames) == MIN_SIGHTINGS


def test_a_mirrored_camera_is_told_from_its_mirrored_picture() -> None:
    assert "this camera is mirrored" in explain_absence(BOARD, [BLANK, PICTURE[:, ::-1]])


def test_a_board_with_black_and_white_exchanged_is_said_to_be_inverted() -> None:
    inverted = replace(BOARD, is_inverted=True)
    assert "inverted = true" in explain_absence(BOARD, [draw_board(inverted, PER_M, MARGIN)])
    assert "inverted = true" in explain_absence(inverted, [PICTURE])


def test_of_a_checkerboard_its_squares_are_doubted() -> None:
    words = explain_absence(Board("checkerboard", 6, 5, 0.04), [PICTURE])
    assert words == "A checkerboard must be seen whole; are its squares counted with the outer ones?"


def test_markers_of_its_family_in_other_places_are_counted() -> None:
    other = Board("charuco", 4, 7, 0.04, 0.03, "DICT_5X5_100")
    words = explain_absence(BOARD, [draw_board(other, PER_M, MARGIN)])
    assert words.startswith(
        "14 markers of its family are there, but not where this board has them: check columns, rows"
    )
    alone = np.full((200, 200), 255, np.uint8)
    alone[50:150, 50:150] = cv2.aruco.generateImageMarker(BOARD.markers, 0, 100)
    assert explain_absence(BOARD, [alone]).startswith("1 marker of its family is there")


def test_another_family_is_named_when_three_of_its_markers_are_there() -> None:
    tags = Board("apriltag", 3, 1, 0.05, 0.04, APRILTAG)
    assert explain_absence(BOARD, [draw_board(tags, 2 * PER_M, MARGIN)]).startswith(
        "Markers of DICT_APRILTAG_36h11 are there: another board"
    )
    two = draw_board(Board("apriltag", 2, 1, 0.05, 0.04, APRILTAG), 2 * PER_M, MARGIN)
    assert explain_absence(BOARD, [two]).startswith("No markers at all are there")


@pytest.mark.parametrize("images", [[], [BLANK]])
def test_where_nothing_is_seen_the_film_is_doubted(images: list[np.ndarray]) -> None:
    assert explain_absence(BOARD, images).startswith("No markers at all are there: is this the right video")
