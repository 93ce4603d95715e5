"""Every error of a command is one line on stderr, and its exit code says whether the input was bad."""

from __future__ import annotations

import argparse
import json

import pytest

from server.cli.guarded import CommandError, answer, load_settings, run_guarded
from server.errors import ConflictError, NotFoundError, StudioError
from tracker import TrackerError


class DownError(StudioError):
    """A part of the studio is down."""

    status_code = 503


@pytest.mark.parametrize(
    ("error", "code"),
    [
        (CommandError("no such project"), 2),
        (CommandError("the worker died", 1), 1),
        (TrackerError("no such camera"), 2),
        (NotFoundError("no such recording"), 2),
        (ConflictError("somebody was first"), 2),
        (DownError("the database is down"), 1),
        (FileNotFoundError(2, "No such file or directory", "a.ply"), 1),
    ],
)
def test_an_error_is_said_in_one_line_and_by_the_exit_code(capsys, error: Exception, code: int) -> None:
    def fail(_args: argparse.Namespace) -> int:
        raise error

    assert run_guarded(fail)(argparse.Namespace()) == code
    out, said = capsys.readouterr()
    assert out == "" and said.startswith("handloom: ") and said.count("\n") == 1
    assert (error.detail if isinstance(error, StudioError) else str(error)) in said


def test_what_nobody_foresaw_is_not_hidden() -> None:
    def fail(_args: argparse.Namespace) -> int:
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        run_guarded(fail)(argparse.Namespace())


def test_a_setting_that_makes_no_sense_is_named_as_people_set_it(capsys) -> None:
    def work(_args: argparse.Namespace) -> int:
        load_settings(port="many")
        return 0

    assert run_guarded(work)(argparse.Namespace()) == 2
    assert "HANDLOOM_PORT: " in capsys.readouterr().err


def test_what_was_not_given_on_the_command_line_is_as_the_settings_have_it(monkeypatch) -> None:
    monkeypatch.setenv("HANDLOOM_PORT", "8123")
    assert load_settings(port=None).port == 8123 and load_settings(port=8124).port == 8124


@pytest.mark.parametrize("is_json", [True, False])
def test_an_answer_is_one_json_object_or_a_line_for_people(capsys, is_json: bool) -> None:
    result = {"name": "ball", "frames": 9}
    assert answer(argparse.Namespace(json=is_json), result, "ball: 9 frames") == 0
    out = capsys.readouterr().out
    assert json.loads(out) == result if is_json else out == "ball: 9 frames\n"
