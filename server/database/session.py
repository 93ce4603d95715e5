"""The session of a request."""

from __future__ import annotations

from asyncio import get_running_loop
from collections.abc import AsyncIterator, Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import AbstractContextManager
from typing import Annotated, TypeVar

from anyio import CapacityLimiter
from fastapi import Depends
from fastapi.concurrency import contextmanager_in_threadpool
from sqlalchemy.orm import Session
from starlette.requests import HTTPConnection

from server.database.database import Database

READERS, WRITERS = 4, 3
"""Requests that have a session at once by `SessionDep`, and as many again by `Admission.read` and `write`. All together
fewer than the engine's pool has connections (15), so that work beside them always finds one. On SQLite one writes."""

Result = TypeVar("Result")


class Admission:
    """Requests wait here for their session, and not in a thread that another one needs.

    A request with `SessionDep` gives its thread back between its dependencies and its route, and keeps its session. If
    those that wait held the threads, those that have a session would find none to go on in: fifty saves at once stood
    still until locks and connections were given up. `read` and `write` have threads of their own, as many as sessions.
    """

    def __init__(self, database: Database) -> None:
        writers = 1 if database.is_sqlite else WRITERS
        self._database = database
        self.readers, self.writers = CapacityLimiter(READERS), CapacityLimiter(writers)
        self._reading, self._writing = ThreadPoolExecutor(READERS, "read"), ThreadPoolExecutor(writers, "write")

    async def read(self, work: Callable[[Session], Result]) -> Result:
        """What `work` finds, in one go on one thread."""
        return await get_running_loop().run_in_executor(self._reading, _run, self._database.reading, work)

    async def write(self, work: Callable[[Session], Result]) -> Result:
        """What `work` gives, committed: the turn to write is held for its statements and no longer. `SessionDep` takes
        it before the dependencies of the route and gives it back after the route, with a change of threads each."""
        return await get_running_loop().run_in_executor(self._writing, _run, self._database.writing, work)

    def close(self) -> None:
        """End the threads, when they have done what was begun."""
        self._reading.shutdown()
        self._writing.shutdown()


def _run(opened: Callable[[], AbstractContextManager[Session]], work: Callable[[Session], Result]) -> Result:
    with opened() as session:
        return work(session)


async def get_database(connection: HTTPConnection) -> Database:
    """The app's database, for routes whose work is longer than one transaction."""
    return connection.app.state.database


DatabaseDep = Annotated[Database, Depends(get_database)]


async def get_admission(connection: HTTPConnection) -> Admission:
    """The app's, for routes that are asked so often that each change of threads counts."""
    return connection.app.state.admission


AdmissionDep = Annotated[Admission, Depends(get_admission)]


async def get_session(connection: HTTPConnection, database: DatabaseDep) -> AsyncIterator[Session]:
    """Commits when the route has returned and before the answer leaves, so that what was answered is stored."""
    admission: Admission = connection.app.state.admission
    reads_only = connection.scope.get("method") in ("GET", "HEAD")
    opened = database.reading() if reads_only else database.writing()
    async with (
        admission.readers if reads_only else admission.writers,
        contextmanager_in_threadpool(opened) as session,
    ):
        yield session


SessionDep = Annotated[Session, Depends(get_session, scope="function")]
"""Services flush; the request commits."""
