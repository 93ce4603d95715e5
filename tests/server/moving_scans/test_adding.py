"""Frames keep their places, a file that cannot be used says why, and one unit holds for a whole moving scan."""

from __future__ import annotations

import uuid
from pathlib import Path, PurePosixPath

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from server.errors import InvalidError
from server.moving_scans.adding import _find_name, _make_row
from server.moving_scans.frame_files import FrameRead, find_view, read_frames
from server.moving_scans.schemas import MovingScanOptions
from tracker.capture.scan import Scan, save_scan
from tracker.model.body_model import body_model

OPTIONS = MovingScanOptions()
POINTS = body_model().template[::5]


def write_person(path: Path, scale: float = 1.0) -> None:
    save_scan(Scan(scale * POINTS, np.zeros_like(POINTS), name="person"), path)


def read(folder: Path, files: list[str], unit: float | None = None) -> list[FrameRead]:
    return read_frames(None, folder, list(enumerate(files)), unit)  # type: ignore[arg-type]  # reads no context


def test_the_first_frame_that_can_be_read_tells_the_unit_of_all_and_others_say_what_is_wrong(tmp_path) -> None:
    (tmp_path / "0.ply").write_bytes(b"ply\nno scan")
    write_person(tmp_path / "1.ply", 1000.0)
    write_person(tmp_path / "2.ply", 1000.0)
    broken, first, second = read(tmp_path, ["0.ply", "1.ply", "2.ply"])
    assert broken.problem is not None and str(tmp_path) not in broken.problem and broken.point_count == 0
    assert (first.metres_per_unit, second.metres_per_unit) == (0.001, 0.001)
    assert first.problem is None and first.point_count == second.point_count > 1000
    assert np.allclose(np.array(first.high) - first.low, np.ptp(POINTS, axis=0), atol=1e-3), "m"
    assert [find_view(tmp_path, frame).is_file() for frame in range(3)] == [False, True, True]


def test_a_unit_that_somebody_said_is_not_guessed(tmp_path) -> None:
    write_person(tmp_path / "0.ply")
    (one,) = read(tmp_path, ["0.ply"], 1.0)
    assert one.metres_per_unit == 1.0


def test_the_box_is_around_all_usable_frames_and_the_digest_of_all_files_in_their_order() -> None:
    reads = [
        FrameRead("a", 5, 1.0, (0.0, -1.0, 0.0), (1.0, 1.0, 1.0)),
        FrameRead("b", problem="is broken"),
        FrameRead("c", 7, 1.0, (-2.0, 0.0, 0.0), (0.5, 3.0, 0.5)),
    ]
    names, files = ["x/1.ply", "x/2.ply", "x/3.ply"], ["000000.ply", "000001.ply", "000002.ply"]
    row = _make_row(uuid.uuid4(), names, files, reads, OPTIONS, [])
    assert row.box_m == [[-2.0, -1.0, 0.0], [1.0, 3.0, 1.0]]
    assert (row.frame_count, row.usable_count, row.is_unit_guessed) == (3, 2, True)
    assert [frame["problem"] for frame in row.frames] == [None, "is broken", None]
    turned = _make_row(uuid.uuid4(), names, files, reads[::-1], OPTIONS, [])
    assert turned.digest != row.digest
    with pytest.raises(InvalidError, match=r"None of the scans can be used\. x/1\.ply: is broken"):
        _make_row(uuid.uuid4(), names[:1], files[:1], reads[1:2], OPTIONS, [])


@given(st.lists(st.sampled_from(["walk/1.ply", "walk/2.ply", "run/1.ply", "3.ply"]), min_size=1, max_size=4))
def test_a_moving_scan_is_called_as_the_one_folder_that_its_files_lie_in(names) -> None:
    folders = {PurePosixPath(name).parent.name for name in names}
    assert _find_name(names) == (folders.pop() if len(folders) == 1 else "")
