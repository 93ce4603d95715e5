"""The viewer sessions of the studio: which there are, which track each shows, and which have been idle for too long."""

from __future__ import annotations

import logging
import threading
import time
import uuid
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from server.errors import NotFoundError
from server.viewer.link import ViewerLink, ViewerUnavailableError

log = logging.getLogger(__name__)

MAX_SESSIONS = 8
IDLE_SECONDS = 600.0
"""A session that nobody has a page open of and nobody changed for so long is closed."""

SWEEP_SECONDS = 30.0


class ViewerSessionNotFoundError(NotFoundError):
    """There is no viewer session of this id, or it was closed because nobody used it."""


@dataclass
class OpenSession:
    """One session in the viewer process."""

    id: uuid.UUID
    track_id: uuid.UUID
    port: int
    generation: int
    last_used: float = field(default_factory=time.monotonic)
    pages: int = 0
    """Open sockets of browsers."""


class ViewerSessions:
    """All sessions; used from any thread."""

    def __init__(self) -> None:
        self._link = ViewerLink()
        self._sessions: dict[uuid.UUID, OpenSession] = {}
        self._lock = threading.Lock()
        self._stopped = threading.Event()
        threading.Thread(target=self._sweep_forever, name="viewer-sessions", daemon=True).start()

    def prepare(self) -> None:
        """Have the viewer process ready before somebody asks for a view."""
        self._link.start()

    def open(
        self, track_id: uuid.UUID, recording: Path, track: Path, frame: int | None, changes: dict[str, Any]
    ) -> tuple[OpenSession, dict[str, Any]]:
        """Begin a session; the least recently used one goes when there are too many."""
        session_id = uuid.uuid4()
        self._close_all(self._least_used(keep=MAX_SESSIONS - 1))
        answer = self._link.request(
            "open",
            str(session_id),
            recording=str(recording),
            track=str(track),
            frame=frame,
            dark=changes.get("dark", True),
        )
        session = OpenSession(session_id, track_id, answer["port"], self._link.generation)
        with self._lock:
            self._sessions[session_id] = session
        if changes:
            answer = self.show(session_id, None, changes)[1]
        return session, answer

    def show(
        self, session_id: uuid.UUID, frame: int | None, changes: dict[str, Any]
    ) -> tuple[OpenSession, dict[str, Any]]:
        """Go to a frame and change layers; returns when the scene is there."""
        session = self.get(session_id)
        try:
            return session, self._link.request("show", str(session_id), frame=frame, changes=changes)
        except ViewerUnavailableError:
            self._forget_dead()
            raise

    def get(self, session_id: uuid.UUID) -> OpenSession:
        """A session that lives; it counts as used now."""
        self._forget_dead()
        with self._lock:
            session = self._sessions.get(session_id)
        if session is None:
            raise ViewerSessionNotFoundError("This view is closed. Open it again.")
        session.last_used = time.monotonic()
        return session

    def close(self, session_id: uuid.UUID) -> None:
        """End a session; it may have ended already."""
        with self._lock:
            session = self._sessions.pop(session_id, None)
        if session is not None and session.generation == self._link.generation:
            self._link.request("close", str(session_id))

    def stop(self) -> None:
        """End all sessions and the viewer process."""
        self._stopped.set()
        with self._lock:
            self._sessions.clear()
        self._link.stop()

    def close_idle(self) -> None:
        """Close sessions that are not used."""
        now = time.monotonic()
        with self._lock:
            idle = [s for s in self._sessions.values() if s.pages == 0 and now - s.last_used > IDLE_SECONDS]
        self._close_all(idle)

    def _least_used(self, keep: int) -> list[OpenSession]:
        with self._lock:
            ordered = sorted(self._sessions.values(), key=lambda session: session.last_used)
        return ordered[: max(0, len(ordered) - keep)]

    def _close_all(self, sessions: list[OpenSession]) -> None:
        for session in sessions:
            log.info("viewer session %s closed", session.id)
            self.close(session.id)

    def _forget_dead(self) -> None:
        """Drop the sessions of a viewer process that is gone."""
        generation = self._link.generation if self._link.is_alive else -1
        with self._lock:
            self._sessions = {i: s for i, s in self._sessions.items() if s.generation == generation}

    def _sweep_forever(self) -> None:
        while not self._stopped.wait(SWEEP_SECONDS):
            try:
                self.close_idle()
            except ViewerUnavailableError as error:
                log.warning("idle viewer sessions not closed: %s", error)
