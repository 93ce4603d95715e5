"""The viewer process: holds the viser servers of all sessions, away from the process that answers the API.

The studio talks to it through a socket pair: a message is `{"id", "op", "session", ...}`, an answer `{"id", "answer"}`
or `{"id", "error"}`. When the studio goes away the socket closes, and with it this process.
"""

from __future__ import annotations

import logging
import os
import signal
import socket
import sys
import threading
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

from server.viewer.session import Answer, ViewSession

log = logging.getLogger(__name__)


class ViewerProcess:
    """Answers the messages of one connection."""

    def __init__(self, connection: Connection) -> None:
        self._connection = connection
        self._sending = threading.Lock()
        self._sessions: dict[str, ViewSession] = {}

    def serve(self) -> None:
        while True:
            try:
                message = self._connection.recv()
            except (EOFError, OSError):
                return
            try:
                self._handle(message)
            except Exception as error:
                self._send(message["id"], error)

    def _handle(self, message: dict[str, Any]) -> None:
        number, session_id = message["id"], message["session"]

        def reply(answer: Answer | Exception) -> None:
            self._send(number, answer)

        if message["op"] == "open":
            self._sessions[session_id] = ViewSession(
                Path(message["recording"]), Path(message["track"]), message["frame"], message["dark"], reply
            )
        elif message["op"] == "show":
            self._sessions[session_id].show(message["frame"], message["changes"], reply)
        elif message["op"] == "close":
            session = self._sessions.pop(session_id, None)
            if session is not None:
                session.close()
            self._send(number, {})
        else:
            raise ValueError(f"unknown operation {message['op']!r}")

    def _send(self, number: int, answer: Answer | Exception) -> None:
        if isinstance(answer, Exception):
            body = {"id": number, "error": f"{type(answer).__name__}: {answer}"}
        else:
            body = {"id": number, "answer": answer}
        with self._sending:
            try:
                self._connection.send(body)
            except OSError:
                log.debug("the studio is gone; answer %d dropped", number)


def main() -> None:
    """Serve the socket whose descriptor is the first argument until it closes."""
    logging.basicConfig(stream=sys.stderr, level=logging.WARNING, format="viewer: %(levelname)s %(name)s: %(message)s")
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    descriptor = int(sys.argv[1])
    connection = Connection(socket.socket(fileno=descriptor).detach())
    threading.Thread(target=_load_tracker, name="load", daemon=True).start()
    ViewerProcess(connection).serve()
    sys.stderr.flush()
    os._exit(0)


def _load_tracker() -> None:
    """What takes seconds, before it is needed."""
    from tracker import load_track
    from tracker.inspection import describe_frame

    log.debug("%s and %s are ready", describe_frame, load_track)


if __name__ == "__main__":
    main()
