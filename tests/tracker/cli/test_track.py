"""`handloom track` refuses what it cannot do before it looks for a hand, and says what is a guess."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from tests.tracker.capture.conftest import write_recording
from tracker.cli.__main__ import main
from tracker.cli.track import show

RESULT: dict[str, Any] = {
    "out": "tracks/1",
    "frames": 12,
    "lost": 1,
    "objects": {},
    "median_ms": 8.25,
    "is_distance_guessed": False,
    "doubts": [],
}


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--frames", "2:"], "There are 2 frames, 0 to 1; none is left of 2:None."),
        (["--terms", "LX"], "terms"),
        (["--iterations", "0"], "iterations"),
        (["--camera", "cam7"], "cam7"),
        (["--hand", "left=a.npz"], "--hand left: there are the hands ['right'] only."),
        (["--object", "cup=a.npz"], "--object cup: the recording names no objects."),
        (["--annotations", "nowhere.json"], "nowhere.json"),
        (["--detector", "nowhere.npz"], "nowhere.npz"),
    ],
)
def test_what_cannot_be_tracked_is_refused_and_nothing_is_written(arguments, said, tmp_path: Path, capsys) -> None:
    folder = write_recording(tmp_path / "plate", 2)
    assert main(["track", str(folder), "--out", str(tmp_path / "out"), *arguments]) == 2
    assert said in capsys.readouterr().err and not (tmp_path / "out").exists()


def test_a_file_is_no_folder_for_a_track(tmp_path: Path, capsys) -> None:
    folder = write_recording(tmp_path / "plate", 2)
    (tmp_path / "out").write_text("mine")
    assert main(["track", str(folder), "--out", str(tmp_path / "out")]) == 2
    assert "out: is a file; --out needs a folder." in capsys.readouterr().err
    assert (tmp_path / "out").read_text() == "mine"


def test_a_track_is_told_in_a_line_with_what_was_lost_of_each() -> None:
    assert show(RESULT) == "12 frames, 1 lost, median 8.2 ms a frame: tracks/1"
    objects = {"cup": {"lost": 3}, "ball": {"lost": 0}}
    assert show(RESULT | {"frames": 1, "objects": objects}) == (
        "1 frame, 1 lost, cup lost in 3, ball lost in 0, median 8.2 ms a frame: tracks/1"
    )


def test_guesses_and_doubts_follow_a_line_each() -> None:
    said = show(RESULT | {"is_distance_guessed": True, "doubts": ["cam1 is out of step.", "cam2 too."]}).splitlines()
    assert said[1:] == [
        "One colour camera alone was tracked in: the hands' size and distance are guesses.",
        "cam1 is out of step.",
        "cam2 too.",
    ]
