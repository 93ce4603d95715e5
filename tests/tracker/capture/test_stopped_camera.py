"""A camera that stopped is named before anything is tracked, with where it ends."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from tests.tracker.search.test_mirrored_views import rendered
from tracker.capture.sequence import Sequence, load_sequence
from tracker.capture.stopped_camera import check_cameras_last
from tracker.cli.__main__ import main
from tracker.errors import FrameError

__all__ = ["rendered"]


@pytest.fixture
def stopped(rendered: Sequence, tmp_path: Path) -> Sequence:
    """The second of three cameras has colour up to frame 3 of 5, the third no depth."""
    folder = tmp_path / "stopped"
    shutil.copytree(rendered.folder, folder)
    for frame in (4, 5):
        (folder / "cam1" / "color" / f"{frame:06d}.png").unlink()
    shutil.rmtree(folder / "cam2" / "depth")
    return load_sequence(folder)


def test_it_is_said_where_a_camera_ends_and_what_to_do(stopped: Sequence) -> None:
    with pytest.raises(FrameError, match=r"^Camera cam1: its colour images end after frame 3; .*--frames 1:4`"):
        check_cameras_last(stopped, ("cam0", "cam1"), range(1, 6))
    with pytest.raises(FrameError, match=r"^Camera cam2: none of its depth images from frame 0 on is there"):
        check_cameras_last(stopped, ("cam2",), range(6))


def test_what_a_run_does_not_look_at_may_be_missing(stopped: Sequence) -> None:
    check_cameras_last(stopped, ("cam0",), range(6))
    check_cameras_last(stopped, ("cam0", "cam1", "cam2"), range(4), with_depth=False)


def test_the_command_says_so_and_writes_nothing(stopped: Sequence, tmp_path: Path, capsys) -> None:
    out = tmp_path / "track"
    words = ["track", str(stopped.folder), "--cameras", "cam0,cam1", "--no-depth", "--out", str(out)]
    assert main(words) == 2
    assert "Camera cam1: its colour images end after frame 3" in capsys.readouterr().err
    assert not out.exists()
