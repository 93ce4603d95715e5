"""The studio's end of the socket to the viewer process, which it starts when it is first needed."""

from __future__ import annotations

import logging
import socket
import subprocess
import sys
import threading
from concurrent.futures import Future
from concurrent.futures import TimeoutError as FutureTimeoutError
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

from server.errors import StudioError

log = logging.getLogger(__name__)

CODE = Path(__file__).resolve().parents[2]
"""Where Python finds `server`, installed or not."""

ANSWER_TIMEOUT = 60.0
"""s; opening the first session loads the tracker."""


class ViewerUnavailableError(StudioError):
    """The viewer process did not do what it was asked."""

    status_code = 500


class ViewerLink:
    """Sends requests to the viewer process from any thread. A process that died is replaced; its sessions are lost."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._process: subprocess.Popen[bytes] | None = None
        self._connection: Connection | None = None
        self._pending: dict[int, Future[dict[str, Any]]] = {}
        self._next_id = 0
        self.generation = 0
        """Counts the processes started; sessions of an earlier one are gone."""

    @property
    def is_alive(self) -> bool:
        """Whether the viewer process runs."""
        process = self._process
        return process is not None and process.poll() is None

    def start(self) -> None:
        """Start the viewer process now, so that the first view opens sooner."""
        with self._lock:
            self._ensure_started()

    def request(self, op: str, session: str, **arguments: Any) -> dict[str, Any]:
        """Ask and wait for the answer."""
        future: Future[dict[str, Any]] = Future()
        with self._lock:
            connection = self._ensure_started()
            self._next_id += 1
            self._pending[self._next_id] = future
            try:
                connection.send({"id": self._next_id, "op": op, "session": session, **arguments})
            except OSError as error:
                self._pending.pop(self._next_id)
                raise ViewerUnavailableError(f"The viewer process has ended: {error}. Open the view again.") from error
        try:
            return future.result(timeout=ANSWER_TIMEOUT)
        except FutureTimeoutError as error:
            raise ViewerUnavailableError(f"The viewer gave no answer within {ANSWER_TIMEOUT:.0f} s.") from error

    def stop(self) -> None:
        """End the viewer process."""
        with self._lock:
            process, self._process = self._process, None
            self._connection = None
        if process is not None:
            process.terminate()
            process.wait(timeout=10)

    def _ensure_started(self) -> Connection:
        if self._connection is not None and self.is_alive:
            return self._connection
        ours, theirs = socket.socketpair()
        with theirs:
            self._process = subprocess.Popen(
                [sys.executable, "-m", "server.viewer.process", str(theirs.fileno())],
                pass_fds=[theirs.fileno()],
                stdin=subprocess.DEVNULL,
                cwd=CODE,
            )
        self._connection = Connection(ours.detach())
        self.generation += 1
        threading.Thread(target=self._receive, args=(self._connection,), name="viewer-link", daemon=True).start()
        log.info("viewer process %d started", self._process.pid)
        return self._connection

    def _receive(self, connection: Connection) -> None:
        while True:
            try:
                message = connection.recv()
            except (EOFError, OSError, TypeError):
                break
            future = self._pending.pop(message["id"], None)
            if future is not None:
                if "error" in message:
                    future.set_exception(ViewerUnavailableError(f"The viewer cannot show this: {message['error']}"))
                else:
                    future.set_result(message["answer"])
        connection.close()
        with self._lock:
            if self._connection is not connection and self._connection is not None:
                return
            pending, self._pending = self._pending, {}
        for future in pending.values():
            future.set_exception(ViewerUnavailableError("The viewer process has ended. Open the view again."))
