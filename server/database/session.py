"""The session of a request."""

from __future__ import annotations

from collections.abc import AsyncIterator, Callable
from contextlib import AbstractContextManager
from typing import Annotated, TypeVar

from anyio import CapacityLimiter
from fastapi import Depends
from fastapi.concurrency import contextmanager_in_threadpool, run_in_threadpool
from sqlalchemy.orm import Session
from starlette.requests import HTTPConnection

from server.database.database import Database

READERS, WRITERS = 4, 4
"""Requests that have a session at once. Together fewer than the engine's pool has connections (15), so that work beside
the requests' sessions always finds one. On SQLite one writes at a time."""


Result = TypeVar("Result")


class Admission:
    """Requests wait here for their session, and not in a thread.

    A request gives its thread back between its dependencies and its route, and keeps its session. If those that wait
    held the threads, those that have a session would find none to go on in: fifty saves at once stood still until locks
    and connections were given up.
    """

    def __init__(self, database: Database) -> None:
        self._database = database
        self.readers = CapacityLimiter(READERS)
        self.writers = CapacityLimiter(1 if database.is_sqlite else WRITERS)

    async def read(self, work: Callable[[Session], Result]) -> Result:
        """What `work` finds, in one go on one thread."""
        async with self.readers:
            return await run_in_threadpool(_run, self._database.reading, work)

    async def write(self, work: Callable[[Session], Result]) -> Result:
        """What `work` gives, committed: the turn to write is held for its statements and no longer. `SessionDep` takes
        it before the dependencies of the route and gives it back after the route, with a change of threads each."""
        async with self.writers:
            return await run_in_threadpool(_run, self._database.writing, work)


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
