"""A trial is run once, kept, and run anew only where other code made it or it failed."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import pytest

from benchmarks.studies.trial import (
    NotMeasured,
    Results,
    describe_trial,
    is_due,
    load_kept,
    path_of,
    run_trials,
)


@dataclass(frozen=True)
class Square:
    """Squares a number and writes down that it was asked."""

    number: int
    fails: bool = False

    def __call__(self, data: Path, twins: Path) -> dict[str, int]:
        with (data / "asked").open("a") as file:
            file.write(f"{self.number}\n")
        if self.fails:
            raise ValueError("will not")
        return {"square": self.number**2}


def asked(folder: Path) -> list[str]:
    return (folder / "asked").read_text().split()


def test_each_trial_runs_once_however_often_it_is_wanted(tmp_path):
    runs = tmp_path / "runs"
    run_trials([Square(2), Square(3), Square(2)], tmp_path, tmp_path, runs, processes=1, keep=False)
    run_trials([Square(3)], tmp_path, tmp_path, runs, processes=1, keep=False)
    assert asked(tmp_path) == ["2", "3"]
    assert Results(runs)[Square(3)] == {"square": 9}


def test_two_processes_give_what_one_gives(tmp_path):
    runs = tmp_path / "runs"
    run_trials([Square(n) for n in range(4)], tmp_path, tmp_path, runs, processes=2, keep=False)
    assert [Results(runs)[Square(n)]["square"] for n in range(4)] == [0, 1, 4, 9]
    assert sorted(asked(tmp_path)) == ["0", "1", "2", "3"]


def test_a_failure_is_kept_and_told_and_stops_nothing(tmp_path):
    runs = tmp_path / "runs"
    run_trials([Square(1, fails=True), Square(2)], tmp_path, tmp_path, runs, processes=1, keep=True)
    assert Results(runs)[Square(2)] == {"square": 4}
    with pytest.raises(NotMeasured, match=r"Square\(number=1, fails=True\) failed: ValueError: will not"):
        Results(runs)[Square(1, fails=True)]
    assert is_due(Square(1, fails=True), runs, keep=True), "it is tried again"


def test_what_was_never_run_says_so(tmp_path):
    with pytest.raises(NotMeasured, match=r"Square\(number=7\) was not run"):
        Results(tmp_path)[Square(7)]


def test_results_of_other_code_are_due_unless_they_are_to_be_kept(tmp_path):
    run_trials([Square(5)], tmp_path, tmp_path, tmp_path, processes=1, keep=False)
    assert not is_due(Square(5), tmp_path, keep=False)
    path = path_of(Square(5), tmp_path)
    path.write_text(json.dumps(json.loads(path.read_text()) | {"code": "older"}))
    assert is_due(Square(5), tmp_path, keep=False)
    assert not is_due(Square(5), tmp_path, keep=True)
    kept = load_kept(Square(5), tmp_path)
    assert kept is not None and kept.result == {"square": 25}


def test_a_trial_is_described_by_what_is_not_usual():
    assert describe_trial(Square(3)) == "Square(number=3)"
