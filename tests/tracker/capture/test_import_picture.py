"""Pictures of an import come by the names of its report: depth raw, colour as RGB, frames of videos by their number."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.tracker.capture.conftest import draw_color, draw_depth, write_png
from tests.tracker.capture.test_film import write_film
from tracker.capture.import_picture import read_import_picture
from tracker.errors import FrameError


def test_depth_comes_raw_and_colour_as_rgb(recording: Path) -> None:
    depth = read_import_picture(recording, "depth/000003.png")
    color = read_import_picture(recording, "color/000003.png")
    assert depth.dtype == np.uint16 and np.array_equal(depth, draw_depth(3))
    assert color.dtype == np.uint8 and np.array_equal(color, draw_color(3))


def test_8_bit_grey_is_a_colour_picture_of_grey(tmp_path: Path) -> None:
    grey = np.arange(600, dtype=np.uint8).reshape(20, 30)
    write_png(tmp_path / "a.png", grey)
    assert np.array_equal(read_import_picture(tmp_path, "a.png"), np.repeat(grey[..., None], 3, axis=2))


def test_names_belong_to_the_folder_that_the_recording_begins_in(recording: Path) -> None:
    outer = recording.parent
    assert np.array_equal(read_import_picture(outer, "depth/000000.png"), draw_depth(0))


def test_a_frame_of_a_video_is_named_by_its_number(tmp_path: Path) -> None:
    video = write_film(tmp_path / "film.avi", 5, "MJPG")
    expected = [image[..., ::-1] for _, image in video.images()]
    for source in (tmp_path, tmp_path / "film.avi"):
        for index in (4, 0, 2):
            assert np.array_equal(read_import_picture(source, f"film.avi#{index}"), expected[index])
    with pytest.raises(FrameError, match=r"^film\.avi, frame 5: cannot be decoded\.$"):
        read_import_picture(tmp_path, "film.avi#5")


def test_a_file_whose_own_name_ends_in_a_number_is_that_file(tmp_path: Path) -> None:
    write_png(tmp_path / "take#7", draw_depth(7))
    write_png(tmp_path / "other.png", draw_depth(0))
    assert np.array_equal(read_import_picture(tmp_path, "take#7"), draw_depth(7))


@pytest.mark.parametrize("name", ["../plate/depth/000000.png", "/etc/passwd", "", "a//b", "color/../depth/000000.png"])
def test_a_name_that_leads_anywhere_else_is_refused_with_its_reason(recording: Path, name: str) -> None:
    write_png(recording / "extra.png", draw_depth(0))
    with pytest.raises(FrameError, match=r"^'.*' .+\.$"):
        read_import_picture(recording, name)


@pytest.mark.parametrize("name", ["depth", "depth/000009.png", "gone.avi#3"])
def test_what_is_no_file_of_the_import_is_told_so(recording: Path, name: str) -> None:
    with pytest.raises(FrameError, match=r": is not a file of this import\.$"):
        read_import_picture(recording, name)


def test_a_damaged_picture_is_named_without_its_place_on_the_disk(recording: Path) -> None:
    (recording / "color/000001.png").write_bytes(b"\x89PNG\r\n\x1a\n and no more")
    with pytest.raises(FrameError, match=r"^color/000001\.png: ") as caught:
        read_import_picture(recording, "color/000001.png")
    assert str(recording) not in str(caught.value)
