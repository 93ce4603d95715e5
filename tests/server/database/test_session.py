"""The session of a request: committed before the answer leaves, kept for nobody when it fails, few of them at once."""

from __future__ import annotations

import asyncio
import threading
import time
from collections.abc import Iterator
from contextlib import closing

import pytest
from fastapi import FastAPI, HTTPException
from fastapi.testclient import TestClient
from sqlalchemy import func, select
from sqlalchemy.orm import Session

from server.access.models import Account
from server.database import Database
from server.database.session import READERS, Admission, SessionDep
from tests.server.rows import make_person


@pytest.fixture
def database_kind() -> str:
    return "sqlite"


@pytest.fixture
def admission(database: Database) -> Iterator[Admission]:
    with closing(Admission(database)) as admission:
        yield admission


@pytest.fixture
def client(database: Database, admission: Admission) -> Iterator[TestClient]:
    """Two routes that add somebody, whatever the method may do."""
    app = FastAPI()
    app.state.database, app.state.admission = database, admission

    def add(name: str, session: SessionDep) -> int:
        session.add(make_person(name))
        session.flush()
        if name == "Nobody":
            raise HTTPException(418)
        return count(session)

    app.add_api_route("/add", add, methods=["GET", "POST"])
    with TestClient(app) as client:
        yield client


def count(session: Session) -> int:
    return session.scalar(select(func.count()).select_from(Account)) or 0


def count_stored(database: Database) -> int:
    with database.reading() as session:
        return count(session)


def test_what_was_answered_is_stored_and_what_failed_is_not(client: TestClient, database: Database) -> None:
    before = count_stored(database)
    assert client.post("/add", params={"name": "Ann"}).json() == before + 1 == count_stored(database)
    assert client.post("/add", params={"name": "Nobody"}).status_code == 418
    assert count_stored(database) == before + 1


def test_a_request_that_reads_changes_nothing(client: TestClient, database: Database) -> None:
    before = count_stored(database)
    assert client.get("/add", params={"name": "Ann"}).json() == before + 1
    assert count_stored(database) == before


def test_more_requests_at_once_than_sessions_are_all_done(client: TestClient, database: Database) -> None:
    before = count_stored(database)
    threads = [
        threading.Thread(target=client.post, args=("/add",), kwargs={"params": {"name": f"Ann {n}"}}) for n in range(12)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(20)
    assert count_stored(database) == before + 12


def run_at_once(admission: Admission, act: str, expected: int) -> int:
    """Most that were at work at the same moment; the first `expected` wait for each other."""
    lock, meeting = threading.Lock(), threading.Barrier(expected, timeout=20)
    at_work, most, begun = 0, 0, 0

    def work(session: Session) -> None:
        nonlocal at_work, most, begun
        with lock:
            at_work, begun = at_work + 1, begun + 1
            most, is_first = max(most, at_work), begun <= expected
        if is_first:
            meeting.wait()
        count(session)
        time.sleep(0.01)
        with lock:
            at_work -= 1

    async def run() -> None:
        await asyncio.gather(*(getattr(admission, act)(work) for _ in range(3 * expected)))

    asyncio.run(run())
    return most


def test_as_many_read_at_once_as_there_are_readers_and_one_writes_on_sqlite(admission: Admission) -> None:
    assert run_at_once(admission, "read", READERS) == READERS == admission.readers.total_tokens
    assert run_at_once(admission, "write", 1) == 1 == admission.writers.total_tokens


def test_work_is_committed_with_what_it_gives_and_taken_back_when_it_raises(
    admission: Admission, database: Database
) -> None:
    before = count_stored(database)

    def add(session: Session) -> int:
        session.add(make_person("Ann"))
        session.flush()
        return count(session)

    def fail(session: Session) -> None:
        session.add(make_person("Bob"))
        session.flush()
        raise LookupError("no")

    assert asyncio.run(admission.write(add)) == before + 1 == count_stored(database)
    with pytest.raises(LookupError, match="no"):
        asyncio.run(admission.write(fail))
    assert asyncio.run(admission.read(count)) == before + 1


def test_closed_it_takes_no_more_work(admission: Admission) -> None:
    admission.close()
    for act in (admission.read, admission.write):
        with pytest.raises(RuntimeError, match="shutdown"):
            asyncio.run(act(count))
