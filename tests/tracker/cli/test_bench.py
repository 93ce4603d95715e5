"""A measurement is told with its floor beside it, the costliest stage first."""

from __future__ import annotations

import pytest

from tracker.cli.__main__ import main
from tracker.cli.bench import show

FOUND = {
    "median_ms": 12.0,
    "p95_ms": 15.0,
    "floor_ms": 8.0,
    "stages_ms": {"posing": 1.0, "solving": 7.0, "reading": 4.0},
    "floor_stages_ms": {"posing": 0.5, "solving": 7.5},
    "frames": 60,
    "lost": 0,
    "iterations": 10,
    "terms": "LO",
    "threads": 1,
}


def test_stages_stand_by_their_cost_with_what_they_cost_alone_where_that_is_known() -> None:
    head, columns, *stages = show({"one_hand": FOUND}).splitlines()
    assert head == (
        "one hand: median 12.0 ms a frame (p95 15.0), floor 8.0 ms, ratio 1.50; LO, 10 iterations, 60 frames, 0 lost"
    )
    assert [stage.split() for stage in stages] == [
        ["solving", "7.00", "7.50"],
        ["reading", "4.00"],
        ["posing", "1.00", "0.50"],
    ]
    assert columns.index("in the frame") + len("in the frame") == stages[0].index("7.00") + 4


def test_cases_follow_one_another_and_none_is_nothing() -> None:
    said = show({"one_hand": FOUND, "two_hands_object_physics": FOUND}).splitlines()
    assert said[5].startswith("two hands object physics: ") and len(said) == 10
    assert show({}) == ""


@pytest.mark.parametrize("frames", ["9", "0", "-1"])
def test_too_few_frames_to_tell_a_median_are_refused(frames: str, capsys) -> None:
    assert main(["bench", "tracking", "--frames", frames]) == 2
    assert f"--frames is {frames}; needed at least 10." in capsys.readouterr().err


def test_a_case_that_there_is_not_is_told_those_there_are(capsys) -> None:
    with pytest.raises(SystemExit):
        main(["bench", "tracking", "--case", "three_hands"])
    said = capsys.readouterr().err
    assert all(case in said for case in ("one_hand", "two_hands", "two_hands_object_physics"))
