"""Options of a moving person's registration are checked before a scan is read; the summary is told in a sentence."""

from __future__ import annotations

from pathlib import Path

import pytest

from tracker.cli.__main__ import main
from tracker.cli.register_body_sequence import show


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--chunk", "-1"], "--chunk is -1; needed 0 to 100000."),
        (["--processes", "0"], "--processes is 0; needed 1 to 256."),
        (["--fps", "0.5"], "--fps is 0.5; needed 1 to 10000."),
        (["--fps", "nan"], "--fps is nan"),
        (["--frames", "2:"], "There are 2 frames, 0 to 1; none is left of 2:None."),
    ],
)
def test_what_cannot_be_done_is_refused_and_nothing_is_written(arguments, said, tmp_path: Path, capsys) -> None:
    scans, out = tmp_path / "scans", tmp_path / "out"
    scans.mkdir()
    for name in ("00.ply", "01.ply"):
        (scans / name).write_bytes(b"not read")
    assert main(["register-body-sequence", str(scans), "--out", str(out), *arguments]) == 2
    assert said in capsys.readouterr().err and not out.exists()


def test_a_folder_without_scans_is_refused(tmp_path: Path, capsys) -> None:
    assert main(["register-body-sequence", str(tmp_path), "--out", str(tmp_path / "out")]) == 2
    assert str(tmp_path) in capsys.readouterr().err and list(tmp_path.iterdir()) == []


def test_guesses_and_errors_are_told_with_what_was_registered() -> None:
    result = {
        "registered": 3,
        "frames": 4,
        "guessed": {"right": [1, 2], "left": []},
        "verdicts": {"good": 2, "check": 1},
        "scan_to_mesh_mm": 1.234,
        "median_seconds": 2.04,
        "errors": ["03.ply: is empty."],
    }
    assert show(result).splitlines() == [
        "3 of 4 frames registered: 2 good, 1 check; right hand guessed in 2, left hand guessed in 0; "
        "1.23 mm mean scan to mesh, 2.0 s a frame",
        "03.ply: is empty.",
    ]
