"""The link to the viewer's process: it is started by the first question, and its end is told to whoever waits."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from server.viewer.link import ViewerLink, ViewerUnavailableError


@pytest.fixture
def link() -> Iterator[ViewerLink]:
    link = ViewerLink()
    yield link
    link.stop()


def pid_of(link: ViewerLink) -> int:
    assert link._process is not None
    return link._process.pid


def ask_in_vain(link: ViewerLink, folder: Path) -> str:
    """A question that the process answers with an error, which it lives through."""
    with pytest.raises(ViewerUnavailableError) as told:
        link.request("open", "a", recording=str(folder / "gone"), track=str(folder / "gone"), frame=None, dark=True)
    return told.value.detail


def test_no_process_runs_before_the_first_question_and_one_answers_all(link: ViewerLink, tmp_path: Path) -> None:
    assert not link.is_alive and link.generation == 0
    assert "cannot show this" in ask_in_vain(link, tmp_path)
    first = pid_of(link)
    ask_in_vain(link, tmp_path)
    assert link.is_alive and (pid_of(link), link.generation) == (first, 1)


def test_after_it_was_killed_the_next_question_starts_another(link: ViewerLink, tmp_path: Path) -> None:
    link.start()
    first = pid_of(link)
    os.kill(first, signal.SIGKILL)
    deadline = time.monotonic() + 20
    while link.is_alive and time.monotonic() < deadline:
        time.sleep(0.02)
    assert not link.is_alive
    assert "cannot show this" in ask_in_vain(link, tmp_path)
    assert pid_of(link) != first and link.generation == 2


def test_who_waits_when_it_dies_is_told_to_open_the_view_again(link: ViewerLink, tmp_path: Path) -> None:
    link.start()
    os.kill(pid_of(link), signal.SIGSTOP)
    said: list[str] = []
    waiting = threading.Thread(target=lambda: said.append(ask_in_vain(link, tmp_path)))
    waiting.start()
    deadline = time.monotonic() + 20
    while not link._pending and time.monotonic() < deadline:
        time.sleep(0.02)
    os.kill(pid_of(link), signal.SIGKILL)
    waiting.join(timeout=30)
    assert said == ["The viewer process has ended. Open the view again."]


def test_stopped_it_leaves_no_process(link: ViewerLink) -> None:
    link.start()
    pid = pid_of(link)
    link.stop()
    assert not link.is_alive
    with pytest.raises(ProcessLookupError):
        os.kill(pid, 0)
    link.stop()  # a second time does no harm
