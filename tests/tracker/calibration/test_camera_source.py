"""What cameras filmed, found among what was named."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest

from tests.tracker.calibration.filmed_board import BOARD
from tracker.calibration.camera_source import CameraSource, find_sources
from tracker.calibration.sightings import find_sightings
from tracker.errors import CalibrationError, FrameError


def make_folder(path: Path, sizes: list[tuple[int, int]]) -> Path:
    path.mkdir(parents=True)
    for number, (height, width) in enumerate(sizes):
        cv2.imwrite(str(path / f"{number}.png"), np.full((height, width), number, np.uint8))
    return path


def test_folders_are_cameras_in_the_order_a_person_expects_and_their_images_too(tmp_path: Path) -> None:
    for number in (10, 9, 1):
        make_folder(tmp_path / f"cam{number}", [(24, 32)] * 11)
    sources = find_sources([tmp_path], fps=5.0)
    assert [source.id for source in sources] == ["cam1", "cam9", "cam10"]
    read = list(sources[0].read())
    assert [time for time, _ in read] == pytest.approx([k / 5 for k in range(11)])
    assert [int(image[0, 0]) for _, image in read] == list(range(11))


def test_a_frame_of_another_size_and_a_damaged_one_are_named(tmp_path: Path) -> None:
    (first, _) = find_sources(
        [make_folder(tmp_path / "a", [(24, 32), (20, 32)]), make_folder(tmp_path / "b", [(9, 9)])]
    )
    with pytest.raises(FrameError, match=r"a, frame 1: is 32x20 px, the first one 32x24"):
        list(first.read())
    (tmp_path / "a" / "1.png").write_bytes(b"no image")
    with pytest.raises(FrameError, match=r"a/1\.png"):
        list(first.read())


def test_what_is_missing_is_named(tmp_path: Path) -> None:
    (tmp_path / "empty").mkdir()
    with pytest.raises(CalibrationError, match=r"nothing: .* does not exist"):
        find_sources([tmp_path / "nothing", tmp_path / "empty"])
    with pytest.raises(CalibrationError, match=r"empty: .* holds no images"):
        find_sources([tmp_path / "empty", make_folder(tmp_path / "a", [(9, 9)])])


def test_a_video_with_fewer_frames_than_it_promises_stopped_in_the_middle(tmp_path: Path) -> None:
    folder = make_folder(tmp_path / "a", [(24, 32)] * 6)
    source = CameraSource("cam3", folder, tuple(f"{k}.png" for k in range(6)), 30.0, promised=12)
    with pytest.raises(FrameError, match=r"cam3: stops in the middle: 6 frames of the 12 .* leave this camera out"):
        find_sightings(source, BOARD)
