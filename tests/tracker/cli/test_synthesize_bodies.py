"""Numbers of people, frames and points out of their limits are refused before anything is made."""

from __future__ import annotations

from pathlib import Path

import pytest

from tracker.cli.__main__ import main
from tracker.cli.synthesize_bodies import show


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--people", "0"], "--people is 0; needed 1 to 100000."),
        (["--first", "-1"], "--first is -1; needed 0 to 2.14748e+09."),
        (["--frames", "100001"], "--frames is 100001; needed 0 to 100000."),
        (["--frames", "-1"], "--frames is -1"),
        (["--points", "99"], "--points is 99; needed 100 to 1e+06."),
        (["--noise-mm", "20.5"], "--noise-mm is 20.5; needed 0 to 20."),
        (["--missing", "1.01"], "--missing is 1.01; needed 0 to 1."),
        (["--missing", "nan"], "--missing is nan"),
        (["--seed", "-5"], "--seed is -5"),
    ],
)
def test_a_number_out_of_its_limits_is_refused_and_nothing_is_written(arguments, said, tmp_path: Path, capsys) -> None:
    assert main(["synthesize-bodies", "--out", str(tmp_path / "out"), *arguments]) == 2
    assert said in capsys.readouterr().err and not (tmp_path / "out").exists()


def test_a_file_is_no_folder_to_write_to(tmp_path: Path, capsys) -> None:
    (tmp_path / "out").write_text("mine")
    assert main(["synthesize-bodies", "--out", str(tmp_path / "out"), "--people", "1"]) == 2
    assert "out is a file; needed a folder." in capsys.readouterr().err
    assert (tmp_path / "out").read_text() == "mine"


def test_what_was_made_is_counted() -> None:
    assert show({"scans": 1, "out": "a", "seconds": 2.04}) == "1 scan in a (2.0 s)"
    assert show({"scans": 3, "out": "a", "seconds": 0.1}) == "3 scans in a (0.1 s)"
