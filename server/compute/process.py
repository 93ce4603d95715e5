"""The process that computes: one at most, at low priority, gone when the studio is gone.

`multiprocessing.managers` carries questions and answers: each asking thread has a connection of its own and is answered
by a thread of its own over there, so that a short question does not wait for a long one.
"""

from __future__ import annotations

import contextlib
import logging
import multiprocessing
import os
import shutil
import signal
import tempfile
import threading
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from multiprocessing.connection import Connection
from multiprocessing.managers import BaseManager, BaseProxy
from typing import TYPE_CHECKING, Any

from server.compute.context import ComputeContext
from server.compute.failure import Failure
from server.database import Database
from server.errors import StudioError
from server.log import configure_logging
from server.settings import Settings
from server.storage import open_storage

log = logging.getLogger(__name__)

NICENESS = 10
"""As the command `nice` has it: beside saves, it gets a tenth of a processor that both want."""


LIMIT_SECONDS = 300.0
"""Of one question: far beyond what any test or benchmark needs. Chosen, not measured."""


class ComputeStoppedError(StudioError):
    """The process that computes has ended, twice in a row or because the studio stops."""

    status_code = 503


class ComputeTooLongError(StudioError):
    """A computation took longer than it may, and was ended."""

    status_code = 503


class _Answerer:
    """Answers questions, over there."""

    def __init__(self, settings: Settings) -> None:
        configure_logging(settings.log_level)
        self._context = ComputeContext(Database(settings.sqlalchemy_url), open_storage(settings))

    def get_pid(self) -> int:
        return os.getpid()

    def answer(self, work: Callable[..., Any], arguments: tuple[Any, ...]) -> Any:
        try:
            return work(self._context, *arguments)
        except Exception as error:
            return Failure.of(error)


class _AnswererProxy(BaseProxy):
    _exposed_ = ("answer", "get_pid")

    def get_pid(self) -> int:
        return self._callmethod("get_pid")  # pyright: ignore[reportReturnType]

    def answer(self, work: Callable[..., Any], arguments: tuple[Any, ...]) -> Any:
        return self._callmethod("answer", (work, arguments))


class _Manager(BaseManager):
    if TYPE_CHECKING:

        def make_answerer(self, settings: Settings) -> _AnswererProxy: ...


_Manager.register("make_answerer", _Answerer, _AnswererProxy)


@dataclass(frozen=True)
class _Running:
    """A process that was started. It ends when the lifeline closes, so also when the studio is killed."""

    manager: _Manager
    lifeline: Connection
    folder: str
    answerer: _AnswererProxy
    pid: int

    @classmethod
    def start(cls, settings: Settings) -> _Running:
        context = multiprocessing.get_context("spawn")  # the studio has threads, so it cannot be forked
        theirs, lifeline = context.Pipe(duplex=False)
        folder = tempfile.mkdtemp(prefix="handloom-compute-")
        manager = _Manager(f"{folder}/socket", ctx=context)
        try:
            with theirs:
                manager.start(_live_with, (theirs, folder))
            answerer = manager.make_answerer(settings)
            return cls(manager, lifeline, folder, answerer, answerer.get_pid())
        except BaseException:
            lifeline.close()
            shutil.rmtree(folder, ignore_errors=True)
            raise

    def end(self) -> None:
        """Also when it stands still, and would not hear that it is to end."""
        with contextlib.suppress(ProcessLookupError):
            os.kill(self.pid, signal.SIGKILL)
        self.lifeline.close()
        self.manager.shutdown()
        shutil.rmtree(self.folder, ignore_errors=True)


class ComputeProcess:
    """Asks the process, which is started by the first question, and again by the first one after it died."""

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        self._running: _Running | None = None
        self._is_closed = False
        self._lock = threading.Lock()

    def ask(
        self,
        work: Callable[..., Any],
        arguments: tuple[Any, ...],
        limit_seconds: float | None = LIMIT_SECONDS,
    ) -> Any:
        """What `work` gives over there, or raises. It is asked once more when the process dies meanwhile.

        After `limit_seconds` the process is ended; other questions that it was at are asked again in a new one.
        """
        for _ in range(2):
            running = None
            try:
                running = self._get()
                with _Limit(limit_seconds, partial(self._drop, running)) as limit:
                    answer = running.answerer.answer(work, arguments)
            except (EOFError, ConnectionError, FileNotFoundError) as error:  # of the connection: `work` raises below
                if not self._is_closed:
                    log.warning("the process that computes has ended (%s: %s)", type(error).__name__, error)
                self._drop(running)
                if running is not None and limit.is_over:
                    log.warning("%s took longer than %g s and was stopped", work.__name__, limit_seconds)
                    raise ComputeTooLongError(
                        f"This took longer than {limit_seconds:g} s and was stopped. Ask for less, or try again later; "
                        "if it happens again, the log of the studio says what was computed."
                    ) from None
                continue
            if isinstance(answer, Failure):
                answer.error.add_note(answer.note)
                raise answer.error
            return answer
        raise ComputeStoppedError(
            "The process that computes this crashed twice. Try again; the studio's log says more."
        )

    def close(self) -> None:
        """End the process. Whoever waits for an answer gets a `ComputeStoppedError`."""
        with self._lock:
            self._is_closed = True
            running, self._running = self._running, None
        if running is not None:
            running.end()

    def _get(self) -> _Running:
        with self._lock:
            if self._is_closed:
                raise ComputeStoppedError("The studio is shutting down. Try again when it is running.")
            if self._running is None:
                self._running = _Running.start(self._settings)
            return self._running

    def _drop(self, running: _Running | None) -> None:
        with self._lock:
            if running is None or self._running is not running:
                return
            self._running = None
            running.end()


class _Limit:
    """Does something when a time is over before what it stands around has ended.

    Args:
        seconds: None is no limit.
    """

    def __init__(self, seconds: float | None, act: Callable[[], None]) -> None:
        self.is_over = False
        self._act = act
        self._timer = None if seconds is None else threading.Timer(seconds, self._end)

    def __enter__(self) -> _Limit:
        if self._timer is not None:
            self._timer.daemon = True
            self._timer.start()
        return self

    def __exit__(self, *_error: object) -> None:
        if self._timer is not None:
            self._timer.cancel()

    def _end(self) -> None:
        self.is_over = True
        self._act()


def _live_with(lifeline: Connection, folder: str) -> None:
    """What the process does before all else: step back, and end with the studio."""
    os.nice(NICENESS)
    threading.Thread(target=_end_with, args=(lifeline, folder), name="lifeline", daemon=True).start()


def _end_with(lifeline: Connection, folder: str) -> None:
    with contextlib.suppress(EOFError, OSError):
        lifeline.recv_bytes()
    shutil.rmtree(folder, ignore_errors=True)
    os._exit(0)
