"""What a save and a read ask of the database: a statement more is time that fifty annotators wait for each other."""

from __future__ import annotations

import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest
from sqlalchemy import event

from server.database import Database
from tests.server.conftest import Studio

ENDS = ("BEGIN", "SAVEPOINT", "RELEASE")


@contextmanager
def statements_of(database: Database) -> Iterator[list[str]]:
    """Those that are sent meanwhile, but for what begins and ends a transaction."""
    sent: list[str] = []

    def note(_connection: Any, _cursor: Any, statement: str, *_: Any) -> None:
        if not statement.startswith(ENDS):
            sent.append(" ".join(statement.split()[:3]))

    event.listen(database.engine, "before_cursor_execute", note)
    yield sent
    event.remove(database.engine, "before_cursor_execute", note)


@pytest.fixture
def place(add_recording) -> str:
    """Address of one hand in one frame."""
    return f"/api/v1/sequences/{add_recording('waving')['id']}/annotations/cam0/1/right"


def put(studio: Studio, place: str, revision: int | None, operation: str | None = None) -> None:
    headers = {"If-None-Match": "*"} if revision is None else {"If-Match": f'"{revision}"'}
    body = {"points": [[3.0, 2.0, 2]] * 21, "operation_id": operation or str(uuid.uuid4())}
    assert studio.client.put(place, json=body, headers=headers).status_code == 200


def test_a_save_is_four_statements_the_first_one_as_well_as_a_change(studio: Studio, place: str) -> None:
    with statements_of(studio.database) as first:
        put(studio, place, None)
    assert [statement.split()[0] for statement in first] == ["SELECT", "SELECT", "INSERT", "INSERT"], first
    with statements_of(studio.database) as change:
        put(studio, place, 1)
    assert [statement.split()[0] for statement in change] == ["SELECT", "SELECT", "UPDATE", "INSERT"], change


def test_a_repeated_save_is_one_statement(studio: Studio, place: str) -> None:
    operation = str(uuid.uuid4())
    put(studio, place, None, operation)
    with statements_of(studio.database) as sent:
        put(studio, place, None, operation)
    assert len(sent) == 1, sent


def test_a_read_is_two_statements(studio: Studio, place: str) -> None:
    put(studio, place, None)
    with statements_of(studio.database) as sent:
        assert studio.client.get(place).status_code == 200
    assert len(sent) == 2, sent
