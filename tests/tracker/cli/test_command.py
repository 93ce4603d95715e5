"""Exit codes, `--json` and the reading of arguments."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

import pytest

from tracker.cli.command import choose_frames, parse_hand, parse_named_file, parse_range, run_guarded
from tracker.errors import SequenceError, TrackerError


def run(work, as_json: bool = True) -> int:
    return run_guarded(work, lambda result: f"for people: {result}")(argparse.Namespace(json=as_json))


def test_json_prints_one_object_and_otherwise_words_for_people(capsys):
    assert run(lambda args: {"a": 1}) == 0
    assert json.loads(capsys.readouterr().out) == {"a": 1}
    assert run(lambda args: {"a": 1}, as_json=False) == 0
    assert capsys.readouterr().out.startswith("for people")


def test_bad_input_is_exit_code_2_and_any_other_failure_1_both_said_on_stderr(capsys):
    def refuse(args):
        raise SequenceError("there is no such recording")

    def fail(args):
        raise OSError("disk full")

    assert run(refuse) == 2
    assert run(fail) == 1
    captured = capsys.readouterr()
    assert captured.out == ""
    assert "there is no such recording" in captured.err
    assert "disk full" in captured.err


@pytest.mark.parametrize(
    ("text", "expected"), [("3:9", (3, 9)), ("3:", (3, None)), (":9", (None, 9)), (":", (None, None))]
)
def test_ranges_are_read_as_python_writes_them(text, expected):
    assert parse_range(text) == expected


@pytest.mark.parametrize("text", ["", "3", "a:b", "-3:5", "1:2:3"])
def test_what_is_no_range_is_refused(text):
    with pytest.raises(argparse.ArgumentTypeError, match="write A:B"):
        parse_range(text)


def test_a_range_past_the_end_is_cut_and_an_empty_one_refused():
    assert choose_frames((None, None), 10) == range(10)
    assert choose_frames((4, 99), 10, 2) == range(4, 10, 2)
    with pytest.raises(TrackerError, match="There are 10 frames"):
        choose_frames((10, None), 10)
    with pytest.raises(TrackerError):
        choose_frames((5, 5), 10)


def test_a_hand_is_a_side_with_or_without_a_file():
    assert parse_hand("right") == ("right", None)
    assert parse_hand("left=a=b.npz") == ("left", Path("a=b.npz"))
    assert parse_hand("trained") == ("trained", None)
    for text in ("middle", "middle=a.npz", "right="):
        with pytest.raises(argparse.ArgumentTypeError):
            parse_hand(text)


def test_a_named_file_needs_both_halves():
    assert parse_named_file("ball=b.ply") == ("ball", Path("b.ply"))
    for text in ("ball", "=b.ply", "ball="):
        with pytest.raises(argparse.ArgumentTypeError):
            parse_named_file(text)
