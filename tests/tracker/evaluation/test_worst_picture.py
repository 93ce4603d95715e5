"""A cut-out of one hand: near enough to see, marks in white, the track where it is, or at the edge when far off."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest

from tests.tracker.capture.conftest import draw_color, write_recording
from tracker.capture.sequence import Sequence, load_sequence
from tracker.evaluation.error_color import ANCHORS
from tracker.evaluation.worst_picture import GREY, MARKED, SIZE, draw_worst_picture, encode_jpeg
from tracker.model.joints import HAND_JOINTS

JOINTS = len(HAND_JOINTS)
ALL, NONE = np.full(JOINTS, 2), np.zeros(JOINTS, dtype=bool)
PLACES = np.stack([np.tile(np.linspace(24.0, 40.0, 7), 3), np.repeat([16.0, 24.0, 32.0], 7)], axis=1)
"""A grid within the picture of 64x48 px."""


@pytest.fixture(scope="module")
def sequence(tmp_path_factory: pytest.TempPathFactory) -> Sequence:
    return load_sequence(write_recording(tmp_path_factory.mktemp("plate") / "plate", 1))


def draw(sequence: Sequence, marked=PLACES, tracked=PLACES, visibility=ALL, left_out=NONE) -> np.ndarray:
    return draw_worst_picture(sequence, 0, "cam0", marked, tracked, visibility, left_out)


def count(picture: np.ndarray, color: tuple[int, ...]) -> int:
    return int((np.abs(picture.astype(int) - color).max(axis=2) < 12).sum())


def test_the_picture_has_its_size_and_leaves_the_marks_alone(sequence: Sequence) -> None:
    marked, tracked = PLACES.copy(), PLACES + 3.0
    assert draw(sequence, marked, tracked).shape == (SIZE[1], SIZE[0], 3)
    assert np.array_equal(marked, PLACES) and np.array_equal(tracked, PLACES + 3.0)


def test_a_small_hand_is_shown_by_64_pixels_of_the_image_and_what_it_stands_on_is_darkened(sequence: Sequence) -> None:
    only_one = np.where(np.arange(JOINTS) == 0, 1, 0)
    nowhere = np.full_like(PLACES, np.nan)
    picture = draw(sequence, tracked=nowhere, visibility=only_one)
    away = picture[240:, 200:]
    expected = cv2.warpAffine(draw_color(0), np.array([[6.0, 0, 0], [0, 6.0, 0]]), SIZE, flags=cv2.INTER_LINEAR)[
        240:, 200:
    ]
    assert np.abs(away.astype(int) - (0.75 * expected).astype(int)).max() <= 1, "the whole image, six times as large"


@pytest.mark.parametrize("place", [3, 20])
def test_a_visible_joint_is_filled_an_occluded_one_is_a_ring_and_an_absent_one_is_not_there(
    sequence: Sequence, place: int
) -> None:
    bright = []
    for level in (2, 1, 0):
        visibility = np.where(np.arange(JOINTS) == place, level, np.where(np.arange(JOINTS) == 12, 1, 0))
        picture = draw(sequence, tracked=np.full_like(PLACES, np.nan), visibility=visibility)
        bright.append(int((picture.min(axis=2) > 100).sum()))
    assert bright[0] > bright[1] > bright[2] > 0


def test_marks_that_do_not_count_are_grey_without_a_cross(sequence: Sequence) -> None:
    off = PLACES + np.array([4.0, 0.0])
    counted, left_out = draw(sequence, tracked=off), draw(sequence, tracked=off, left_out=~NONE)
    assert count(left_out, GREY) > count(counted, GREY)
    moved = np.linalg.norm(counted.astype(int) - left_out, axis=2)
    assert (moved > 30).sum() > 500, "the crosses and their lines are gone"


@pytest.mark.parametrize(("off", "anchor"), [(5.0, 1), (10.0, 2), (20.0, 4), (200.0, 4)])
def test_the_track_has_the_colour_of_its_error_up_to_20_px(sequence: Sequence, off: float, anchor: int) -> None:
    picture = draw(sequence, tracked=PLACES + np.array([off, 0.0]))
    shown = [count(picture, tuple(int(part) for part in color)) for color in ANCHORS]
    assert shown[anchor] > 200 and shown[anchor] > 5 * max(shown[:anchor] + shown[anchor + 1 :])


def test_a_track_that_flew_off_does_not_shrink_the_hand_further_than_to_a_third(sequence: Sequence) -> None:
    far, farther = (draw(sequence, tracked=PLACES + np.array([by, 0.0])) for by in (1e3, 1e9))
    assert count(far, MARKED) > 100 and np.array_equal(far, farther), "beyond the window all is alike"


def test_without_colour_the_near_is_bright_and_what_is_unknown_black(tmp_path: Path) -> None:
    folder = write_recording(tmp_path / "depth", 1)
    text = (folder / "sequence.json").read_text().replace('"color/{:06d}.png"', "null")
    (folder / "sequence.json").write_text(text)
    picture = draw(load_sequence(folder), visibility=np.where(np.arange(JOINTS) == 0, 1, 0), tracked=PLACES * np.nan)
    assert picture[10, 10].tolist() == [0, 0, 0] and picture[230, 200].tolist() == [191, 191, 191]


def test_the_jpeg_is_near_the_picture_in_its_colours(sequence: Sequence) -> None:
    picture = draw(sequence)
    decoded = cv2.imdecode(np.frombuffer(encode_jpeg(picture), np.uint8), cv2.IMREAD_COLOR)
    assert decoded is not None and np.abs(decoded[..., ::-1].astype(int) - picture).mean() < 6
