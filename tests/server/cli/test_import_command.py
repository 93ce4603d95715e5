"""A refused import says with which command it would have been taken, and scans are told from recordings."""

from __future__ import annotations

import shlex
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest

from server.cli.import_command import _write_example, _write_options, holds_scans


@dataclass
class Choice:
    value: str


@dataclass
class Question:
    """As an import report has them, as far as a command names them."""

    field: str
    kind: str = "number"
    proposal: Any = None
    choices: list[Choice] = field(default_factory=list)


def read(command: str) -> list[str]:
    return shlex.split(command)


def test_the_example_has_what_was_given_and_what_is_proposed() -> None:
    needed = [Question("fps", proposal=30), Question("allow_gaps", "boolean"), Question("depth_scale")]
    command = _write_example(Path("my folder"), {"format": "rgbd_folder", "fps": 5}, needed, [])
    assert read(command) == [
        *("handloom", "import", "my folder"),
        *("--format", "rgbd_folder", "--fps", "30", "--allow-gaps", "--depth-scale", "N"),
    ]


def test_a_choice_without_a_proposal_is_shown_by_its_first() -> None:
    needed = [Question("format", "choice", None, [Choice("tum_rgbd"), Choice("rgbd_folder")]), Question("K", "choice")]
    assert read(_write_example(Path("a"), {}, needed, []))[3:] == ["--format", "tum_rgbd", "--K", "N"]


def test_a_preset_stands_for_all_that_it_knows() -> None:
    needed = [Question(name) for name in ("fx", "fy", "cx", "cy", "depth_scale", "preset", "fps")]
    assert read(_write_example(Path("a"), {}, needed, ["realsense", "kinect"]))[3:] == [
        *("--preset", "realsense", "--fps", "N")
    ]


def test_a_preset_is_not_named_where_the_camera_is_known() -> None:
    assert "--preset" not in _write_example(Path("a"), {}, [Question("fps")], ["realsense"])


def test_values_are_written_as_the_shell_and_the_parser_take_them() -> None:
    told = _write_options({"name": "the ball; rm -rf", "hands": ("right", "left"), "ok": True, "fx": None, "fy": 5.5})
    assert told == ["--name", "'the ball; rm -rf'", "--hands", "right,left", "--ok", "--fx", "N", "--fy", "5.5"]


@pytest.mark.parametrize(
    ("files", "are_scans"),
    [
        (["a.ply", "b.PLY", "notes.txt"], True),
        (["scans.json"], True),
        (["a.obj"], True),
        (["sequence.json", "ball.ply"], False),
        (["0001.png"], False),
        ([], False),
    ],
)
def test_a_folder_of_scans_is_told_from_a_recording(tmp_path: Path, files: list[str], are_scans: bool) -> None:
    for name in files:
        (tmp_path / name).touch()
    assert holds_scans(tmp_path) is are_scans


def test_a_single_file_is_a_scan_by_its_ending(tmp_path: Path) -> None:
    for name, is_scan in (("a.stl", True), ("a.zip", False), ("a.ply", True)):
        (tmp_path / name).touch()
        assert holds_scans(tmp_path / name) is is_scan
