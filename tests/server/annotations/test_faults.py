"""Annotations when the machine is against us."""

from __future__ import annotations

import time
import uuid
from concurrent.futures import ThreadPoolExecutor
from datetime import UTC, datetime
from typing import Any

import pytest
from fastapi.testclient import TestClient
from sqlalchemy import text

from server.annotations import changes
from server.database import Database


@pytest.fixture
def place(add_recording) -> str:
    """Address of one hand in one frame."""
    return f"/api/v1/sequences/{add_recording('waving')['id']}/annotations/cam0/1/right"


def put(client: TestClient, place: str, x: float, revision: int | None, operation: str | None = None) -> Any:
    headers = {"If-None-Match": "*"} if revision is None else {"If-Match": f'"{revision}"'}
    body = {"points": [[x, 2.0, 2]] * 21, "operation_id": operation or str(uuid.uuid4())}
    return client.put(place, json=body, headers=headers)


def fill_disk(database: Database) -> None:
    """From now on no page more."""
    with database.writing() as session:
        if database.is_sqlite:
            pages = session.execute(text("PRAGMA page_count")).scalar_one()
            session.execute(text(f"PRAGMA max_page_count = {pages}"))
            return
        session.execute(
            text(
                "CREATE FUNCTION no_room() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN "
                "RAISE EXCEPTION 'could not extend file' USING ERRCODE = '53100'; END $$"
            )
        )
        session.execute(
            text("CREATE TRIGGER full_disk BEFORE INSERT ON annotation_revisions EXECUTE FUNCTION no_room()")
        )


def make_room(database: Database) -> None:
    with database.writing() as session:
        if database.is_sqlite:
            session.execute(text("PRAGMA max_page_count = 1000000"))
        else:
            session.execute(text("DROP TRIGGER full_disk ON annotation_revisions"))


def test_a_full_disk_is_said_loses_nothing_and_the_same_gesture_is_taken_later(client: TestClient, place: str) -> None:
    database: Database = client.app.state.database  # type: ignore[attr-defined]
    assert put(client, place, 1.0, None).status_code == 200
    fill_disk(database)
    revision, waiting = 1, str(uuid.uuid4())
    for _ in range(200):  # what is left of pages that were begun takes some more
        answer = put(client, place, revision + 1.0, revision, waiting)
        if answer.status_code != 200:
            break
        revision, waiting = revision + 1, str(uuid.uuid4())
    assert answer.status_code == 507 and answer.json()["error"] == "DiskFullError", answer.text
    now = client.get(place).json()
    assert now["revision"] == revision and now["points"][0][0] == float(revision)
    make_room(database)
    assert put(client, place, revision + 1.0, revision, waiting).json()["revision"] == revision + 1
    history = client.get(f"{place}/history").json()["items"]
    assert [item["revision"] for item in history] == list(range(revision + 1, 0, -1))


def test_a_clock_set_back_changes_neither_order_nor_what_counts(
    client: TestClient, place: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert put(client, place, 1.0, None).status_code == 200
    monkeypatch.setattr(changes, "utc_now", lambda: datetime(1999, 1, 1, tzinfo=UTC))
    assert put(client, place, 2.0, 1).json()["revision"] == 2
    monkeypatch.undo()
    assert put(client, place, 9.0, 1).status_code == 409
    assert put(client, place, 3.0, 2).json()["revision"] == 3
    history = client.get(f"{place}/history").json()["items"]
    assert [(item["revision"], item["points"][0][0]) for item in history] == [(3, 3.0), (2, 2.0), (1, 1.0)]
    assert client.get(place).json()["points"][0][0] == 3.0


def test_many_saves_at_once_wait_for_each_other_and_not_for_a_thread(client: TestClient, add_recording) -> None:
    """After an outage everybody's page saves at once."""
    base = f"/api/v1/sequences/{add_recording('waving', frames=3)['id']}/annotations/cam0"
    places = [f"{base}/{frame}/{hand}" for frame in range(3) for hand in ("right", "left")]
    revisions = {place: put(client, place, 1.0, None).json()["revision"] for place in places}
    began = time.monotonic()
    with ThreadPoolExecutor(90) as people:
        answers = list(
            people.map(lambda n: _save_or_look(client, places[n % 6], revisions[places[n % 6]], n), range(180))
        )
    assert {answer.status_code for answer in answers} == {200, 409}
    assert [answer.status_code for answer in answers if answer.request.method == "PUT"].count(200) == 6
    assert time.monotonic() - began < 10, "they wait until a lock or a connection is given up"


def _save_or_look(client: TestClient, place: str, revision: int, turn: int) -> Any:
    return client.get(place) if turn % 5 == 4 else put(client, place, float(turn % 30), revision)
