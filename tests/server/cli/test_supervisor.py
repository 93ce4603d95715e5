"""The supervisor starts a worker, another one when it dies, and ends the last one with the studio."""

from __future__ import annotations

import logging
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from server.cli import supervisor
from server.cli.supervisor import WorkerSupervisor
from server.settings import Settings

Begin = Callable[[str], Path]


@pytest.fixture
def put_in_place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Begin:
    """Has a shell script run where a worker would; gives a file with a line for each start: what it was told."""
    monkeypatch.setattr(supervisor, "FIRST_PAUSE", 0.01)
    monkeypatch.setattr(supervisor, "STOP_SECONDS", 0.1)

    def put(then: str) -> Path:
        script, starts = tmp_path / "python", tmp_path / "starts"
        script.write_text(f'#!/bin/sh\necho "$HANDLOOM_DATA_DIR $HANDLOOM_DATABASE_URL $*" >> {starts}\n{then}\n')
        script.chmod(0o755)
        monkeypatch.setattr(sys, "executable", str(script))
        return starts

    return put


def wait_for_starts(starts: Path, count: int) -> list[str]:
    ends = time.monotonic() + 20
    while time.monotonic() < ends:
        if starts.exists() and len(lines := starts.read_text().splitlines()) >= count:
            return lines
        time.sleep(0.01)
    raise AssertionError("waited in vain")


def test_a_worker_that_dies_is_followed_by_another_ever_later(
    put_in_place: Begin, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    starts = put_in_place("exit 3")
    settings = Settings(data_dir=tmp_path, database_url="sqlite:///a.sqlite3")
    with caplog.at_level(logging.ERROR), WorkerSupervisor(settings):
        lines = wait_for_starts(starts, 3)
    assert set(lines) == {f"{tmp_path} sqlite:///a.sqlite3 -m server.cli worker --with-parent"}
    pauses = [record.args for record in caplog.records if record.name == supervisor.__name__]
    assert pauses[:2] == [("exit code 3", 0.01), ("exit code 3", 0.02)]


def test_a_worker_that_was_killed_says_by_which_signal(put_in_place: Begin, caplog: pytest.LogCaptureFixture) -> None:
    starts = put_in_place("kill -9 $$")
    with caplog.at_level(logging.ERROR), WorkerSupervisor(Settings()):
        wait_for_starts(starts, 2)
    assert "the worker ended (killed by signal 9); starting another in " in caplog.text


@pytest.mark.parametrize("then", ["exec sleep 600", "trap '' TERM; while :; do sleep 0.05; done"])
def test_the_worker_ends_with_the_supervisor_even_when_it_does_not_listen(
    put_in_place: Begin, then: str, caplog: pytest.LogCaptureFixture
) -> None:
    starts = put_in_place(then)
    began = time.monotonic()
    with caplog.at_level(logging.ERROR), WorkerSupervisor(Settings()):
        assert len(wait_for_starts(starts, 1)) == 1
    assert time.monotonic() - began < 15.0
    assert caplog.records == [] and len(starts.read_text().splitlines()) == 1
