"""The loop's numbers are checked before a scan is read, and a round is told by what it registered and learnt from."""

from __future__ import annotations

from pathlib import Path

import pytest

from tracker.cli.__main__ import main
from tracker.cli.model_loop import show


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--rounds", "0"], "--rounds is 0; it must be from 1 to 10."),
        (["--rounds", "11"], "--rounds is 11; it must be from 1 to 10."),
        (["--processes", "0"], "--processes 0: needed 1 to 256."),
        (["--processes", "257"], "--processes 257: needed 1 to 256."),
    ],
)
def test_what_cannot_be_done_is_refused_and_nothing_is_written(arguments, said, tmp_path: Path, capsys) -> None:
    out = tmp_path / "out"
    assert main(["model-loop", str(tmp_path / "nowhere.ply"), "--out", str(out), *arguments]) == 2
    assert said in capsys.readouterr().err and not out.exists()


def test_when_no_scan_can_be_read_it_is_said_of_each_what_is_wrong_with_it(tmp_path: Path, capsys) -> None:
    (tmp_path / "broken.ply").write_bytes(b"no scan")
    scans = [str(tmp_path / name) for name in ("broken.ply", "nowhere.ply")]
    assert main(["model-loop", *scans, "--out", str(tmp_path / "out")]) == 2
    said = capsys.readouterr().err.splitlines()[-1]
    assert said.startswith("handloom: ") and "broken.ply: found" in said and "nowhere.ply: found" in said
    assert not (tmp_path / "out").exists()


def test_each_round_is_a_line_and_the_last_says_where_the_model_is() -> None:
    rounds = [
        {"registered": {"good": 9, "bad": 1}, "registrations": 9, "residual_mm": 1.234},
        {"registered": {"good": 10}, "registrations": 10, "residual_mm": 0.5},
    ]
    assert show({"out": "out/round_2/model.npz", "rounds": rounds}).splitlines() == [
        "round 1: 1 bad, 9 good; 9 learnt from, 1.23 mm from them",
        "round 2: 10 good; 10 learnt from, 0.50 mm from them",
        "the model: out/round_2/model.npz",
    ]
