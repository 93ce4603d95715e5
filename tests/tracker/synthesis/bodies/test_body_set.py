"""Folders of generated people are whole, go on where they were stopped, and refuse what makes no sense."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from tracker.bodies.body_scan_file import load_body_scan
from tracker.cli.__main__ import main


def test_people_are_written_with_their_truth_and_not_twice(tmp_path: Path, capsys) -> None:
    command = ["synthesize-bodies", "--people", "2", "--points", "3000", "--missing", "1", "--out", str(tmp_path)]
    assert main([*command, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["scans"] == 2
    scan, _ = load_body_scan(tmp_path / "person001_0.ply")
    with np.load(tmp_path / "truth" / "person001_0.npz") as truth:
        assert truth["vertices"].shape == (6683, 3) and truth["joints"].shape == truth["pose"].shape == (52, 3)
        assert not truth["shows_hands"].any() and len(scan.points) == 3000
    written = (tmp_path / "person001_0.ply").stat().st_mtime_ns
    (tmp_path / "truth" / "person000_0.npz").unlink()
    assert main(command) == 0
    assert (tmp_path / "person001_0.ply").stat().st_mtime_ns == written and len(list(tmp_path.glob("*.ply"))) == 2
    assert (tmp_path / "truth" / "person000_0.npz").exists()


def test_a_motion_is_one_scan_a_frame(tmp_path: Path) -> None:
    assert main(["synthesize-bodies", "--frames", "2", "--points", "2000", "--out", str(tmp_path)]) == 0
    assert sorted(path.name for path in tmp_path.glob("*.ply")) == ["000000.ply", "000001.ply"]


@pytest.mark.parametrize("wrong", [["--people", "0"], ["--missing", "2"], ["--points", "1"], ["--noise-mm", "-1"]])
def test_senseless_numbers_are_refused_with_what_is_needed(wrong: list[str], tmp_path: Path, capsys) -> None:
    assert main(["synthesize-bodies", *wrong, "--out", str(tmp_path / "x")]) == 2
    assert wrong[0] in capsys.readouterr().err and not (tmp_path / "x").exists()
