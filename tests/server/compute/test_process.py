"""The process that computes is started when it is asked, ended when it takes too long, and gone when it is closed."""

from __future__ import annotations

import contextlib
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from server.compute.process import ComputeProcess, ComputeStoppedError, ComputeTooLongError
from server.settings import Settings
from tests.server.compute import work
from tests.server.compute.processes import is_alive, stop, wait_until


def test_what_was_never_asked_was_never_started_and_closed_it_says_that_the_studio_ends(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    process = ComputeProcess(Settings(data_dir=tmp_path / "data"))
    for _ in range(2):
        process.close()
    with pytest.raises(
        ComputeStoppedError, match=r"The studio is shutting down. Try again when it is running."
    ) as told:
        process.ask(work.tell_process, ())
    assert told.value.status_code == 503 and list(tmp_path.iterdir()) == []


def test_a_question_that_takes_too_long_is_ended_with_the_time_that_it_had(sqlite_settings, tmp_path):
    with contextlib.closing(ComputeProcess(sqlite_settings)) as process:
        first, _ = process.ask(work.tell_process, ())
        began = time.monotonic()
        with pytest.raises(ComputeTooLongError, match=r"took longer than 1 s and was stopped") as told:
            process.ask(work.sleep, (60.0, tmp_path / "mark"), limit_seconds=1.0)
        assert time.monotonic() - began < 30.0 and told.value.status_code == 503
        wait_until(lambda: not is_alive(first))
        assert process.ask(work.tell_process, ())[0] != first


def test_a_process_that_stands_still_is_ended_too(sqlite_settings):
    with contextlib.closing(ComputeProcess(sqlite_settings)) as process:
        first, _ = process.ask(work.tell_process, ())
        stop(first)
        with pytest.raises(ComputeTooLongError):
            process.ask(work.tell_process, (), limit_seconds=1.0)
        wait_until(lambda: not is_alive(first))
        assert process.ask(work.tell_process, ())[0] != first


def test_the_studio_stops_though_the_process_stands_still(sqlite_settings):
    with contextlib.closing(ComputeProcess(sqlite_settings)) as process:
        first, _ = process.ask(work.tell_process, ())
        stop(first)
    wait_until(lambda: not is_alive(first))


def test_what_else_it_was_at_is_computed_in_the_next_one(sqlite_settings, tmp_path):
    with contextlib.closing(ComputeProcess(sqlite_settings)) as process, ThreadPoolExecutor(1) as other:
        process.ask(work.tell_process, ())
        waiting = other.submit(process.ask, work.sleep, (2.5, tmp_path / "other"))
        wait_until((tmp_path / "other").exists)
        with pytest.raises(ComputeTooLongError):
            process.ask(work.sleep, (60.0, tmp_path / "mark"), limit_seconds=1.0)
        assert waiting.result(timeout=60) == "slept"
