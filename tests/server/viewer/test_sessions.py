"""Sessions of the viewer: those that a process has are gone with it, and unused ones are closed."""

from __future__ import annotations

import uuid
from collections.abc import Iterator
from pathlib import Path

import pytest

from server.viewer import sessions as module
from server.viewer.link import ViewerUnavailableError
from server.viewer.sessions import MAX_SESSIONS, OpenSession, ViewerSessionNotFoundError, ViewerSessions


@pytest.fixture
def sessions() -> Iterator[ViewerSessions]:
    sessions = ViewerSessions()
    yield sessions
    sessions.stop()


def lay_in(sessions: ViewerSessions, count: int, generation: int) -> list[OpenSession]:
    """Sessions of a process, the first used longest ago."""
    made = [OpenSession(uuid.uuid4(), uuid.uuid4(), 1, generation, last_used=float(n)) for n in range(count)]
    sessions._sessions = {session.id: session for session in made}
    return made


def test_a_session_that_nobody_opened_is_said_to_be_closed(sessions: ViewerSessions) -> None:
    with pytest.raises(ViewerSessionNotFoundError, match="Open it again"):
        sessions.get(uuid.uuid4())


def test_the_sessions_of_a_process_that_is_gone_are_gone_too(sessions: ViewerSessions) -> None:
    sessions.prepare()
    living = sessions._link.generation
    [old] = lay_in(sessions, 1, living - 1)
    new = OpenSession(uuid.uuid4(), uuid.uuid4(), 1, living)
    sessions._sessions[new.id] = new
    assert sessions.get(new.id) is new
    with pytest.raises(ViewerSessionNotFoundError):
        sessions.get(old.id)
    sessions.close(old.id)  # it may have ended already


def test_room_is_made_by_those_that_were_used_longest_ago(sessions: ViewerSessions) -> None:
    made = lay_in(sessions, MAX_SESSIONS, 0)
    assert sessions._least_used(keep=MAX_SESSIONS - 1) == made[:1]
    assert sessions._least_used(keep=MAX_SESSIONS) == []


def test_only_what_no_page_shows_is_closed_for_idleness(sessions: ViewerSessions, monkeypatch) -> None:
    monkeypatch.setattr(module.time, "monotonic", lambda: module.IDLE_SECONDS + 1.5)
    idle, watched, used = lay_in(sessions, 3, generation=-7)
    watched.pages = 1
    sessions.close_idle()
    assert set(sessions._sessions) == {watched.id, used.id} and idle.id not in sessions._sessions


def test_a_recording_that_is_gone_is_refused_and_leaves_no_session(sessions: ViewerSessions, tmp_path: Path) -> None:
    with pytest.raises(ViewerUnavailableError, match="cannot show this"):
        sessions.open(uuid.uuid4(), tmp_path / "gone", tmp_path / "gone", None, {})
    assert sessions._sessions == {}
