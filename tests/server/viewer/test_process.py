"""The viewer process answers each message once, says what went wrong, and ends with the studio."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from multiprocessing import Pipe
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

import pytest

from server.viewer.process import ViewerProcess


@pytest.fixture
def studio_end() -> Iterator[Connection]:
    """The studio's end of a socket that a viewer process serves."""
    ours, theirs = Pipe()
    serving = threading.Thread(target=ViewerProcess(theirs).serve)
    serving.start()
    yield ours
    ours.close()
    serving.join(10.0)
    assert not serving.is_alive(), "it ends when the studio is gone"
    theirs.close()


def ask(studio_end: Connection, number: int, op: str, **more: Any) -> dict[str, Any]:
    studio_end.send({"id": number, "op": op, "session": "s", **more})
    assert studio_end.poll(30.0), "an answer comes"
    return studio_end.recv()


def test_closing_what_is_not_open_does_no_harm(studio_end: Connection) -> None:
    assert [ask(studio_end, number, "close") for number in (4, 5)] == [
        {"id": 4, "answer": {}},
        {"id": 5, "answer": {}},
    ]


@pytest.mark.parametrize(
    ("op", "more", "told"),
    [
        ("fly", {}, "ValueError: unknown operation 'fly'"),
        ("show", {"frame": 1, "changes": {}}, "KeyError: 's'"),
        ("open", {"recording": "a"}, "KeyError: 'track'"),
    ],
)
def test_what_cannot_be_done_is_told_and_the_next_message_is_answered(studio_end, op: str, more, told: str) -> None:
    assert ask(studio_end, 1, op, **more) == {"id": 1, "error": told}
    assert ask(studio_end, 2, "close") == {"id": 2, "answer": {}}


def test_a_recording_that_cannot_be_read_is_told_and_its_session_is_closed(studio_end, tmp_path: Path) -> None:
    gone = str(tmp_path / "gone")
    told = ask(studio_end, 1, "open", recording=gone, track=gone, frame=0, dark=True)
    assert told["id"] == 1 and told["error"].startswith("SequenceError: ") and "gone" in told["error"]
    again = ask(studio_end, 2, "show", frame=1, changes={})
    assert again == {"id": 2, "error": "RuntimeError: The viewer session was closed."}
