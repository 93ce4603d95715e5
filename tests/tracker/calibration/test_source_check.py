"""All that is wrong with films, at once."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np

from tracker.calibration.lens import Lens
from tracker.calibration.source_check import check_sources


def make_folder(path: Path, count: int) -> Path:
    path.mkdir()
    for number in range(count):
        cv2.imwrite(str(path / f"{number}.png"), np.zeros((24, 32), np.uint8))
    return path


def test_every_fault_is_told_and_what_can_be_opened_is_described(tmp_path: Path) -> None:
    lens = Lens(np.eye(3), np.zeros(0))
    (tmp_path / "d.mp4").write_text("no video")
    cameras = {"a": make_folder(tmp_path / "a", 10), "b": make_folder(tmp_path / "b", 9)}
    cameras |= {"c": make_folder(tmp_path / "c", 4), "d": tmp_path / "d.mp4"}
    checked = check_sources(cameras, fps=10.0, find_offsets=False, lenses={"a": lens, "b": lens, "d": lens})
    assert [source.id for source in checked.sources] == ["a", "b", "c"] and set(checked.sizes) == {(32, 24)}
    assert len(checked.faults) == 4
    for fault, words in zip(
        checked.faults,
        (
            "d.mp4: is no MP4",
            "b: its video has 9 frames (0.90 s), that of a",
            "c: stops in the middle",
            "c: no lens of",
        ),
        strict=True,
    ):
        assert words in fault
    assert check_sources({"a": cameras["a"], "b": cameras["b"]}, fps=10.0).faults == ()
    [count] = check_sources({"a": cameras["a"]}).faults
    assert count.startswith("1 camera (a); needed 2 to 16")
