"""A viewing session replies to everybody who asked, also where nothing can be shown or it is closed."""

from __future__ import annotations

import threading
from pathlib import Path
from queue import Queue

import pytest

from server.viewer.session import ViewSession
from tests.server.conftest import MakeRecording
from tracker import TrackerError
from tracker.errors import SequenceError

SECONDS = 30.0


@pytest.fixture
def replies() -> Queue:
    return Queue()


def test_who_opens_a_view_of_nothing_is_told_why(tmp_path: Path, replies: Queue) -> None:
    ViewSession(tmp_path / "gone", tmp_path / "gone", 0, True, replies.put)
    told = replies.get(timeout=SECONDS)
    assert isinstance(told, SequenceError) and "gone" in str(told)


def test_a_recording_without_the_track_is_no_view(
    make_recording: MakeRecording, tmp_path: Path, replies: Queue
) -> None:
    ViewSession(make_recording(), tmp_path / "gone", 0, True, replies.put)
    assert isinstance(replies.get(timeout=SECONDS), TrackerError | OSError)


def test_after_its_end_a_session_says_that_it_was_closed(tmp_path: Path, replies: Queue) -> None:
    session = ViewSession(tmp_path / "gone", tmp_path / "gone", None, False, replies.put)
    replies.get(timeout=SECONDS)
    for _ in range(2):
        session.close()
        session.show(3, {}, replies.put)
        told = replies.get(timeout=SECONDS)
        assert isinstance(told, RuntimeError) and str(told) == "The viewer session was closed."
    assert replies.empty(), "everybody is told once"


def test_all_who_wait_when_it_cannot_be_opened_are_told_the_same(tmp_path: Path, replies: Queue, monkeypatch) -> None:
    may_go_on = threading.Event()

    def load_slowly(folder: Path) -> None:
        may_go_on.wait(SECONDS)
        raise SequenceError(f"{folder} is damaged")

    monkeypatch.setattr("tracker.load_sequence", load_slowly)
    session = ViewSession(tmp_path, tmp_path, 0, True, replies.put)
    for frame in (1, 2):
        session.show(frame, {}, replies.put)
    may_go_on.set()
    told = [replies.get(timeout=SECONDS) for _ in range(3)]
    assert {str(one) for one in told} == {f"{tmp_path} is damaged"} and replies.empty()
