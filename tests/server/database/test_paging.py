"""Lists in pages: nothing is skipped, nothing comes twice, and what is no cursor of ours is refused."""

from __future__ import annotations

import uuid
from datetime import UTC, datetime, timedelta
from typing import Any

import pytest
from sqlalchemy import func, select
from sqlalchemy.orm import Session

from server.access.models import Account, AuditRow
from server.database import Database
from server.database.paging import UnknownCursorError, fetch_page, read_cursor, write_cursor

NOW = datetime(2026, 1, 2, 3, 4, 5, 678901, tzinfo=UTC)


def add_lines(database: Database, count: int) -> list[uuid.UUID]:
    """Lines of the audit trail, three at each moment; their ids, the newest first and then the largest id."""
    with database.writing() as session:
        rows = [
            AuditRow(
                id=uuid.uuid4(), time=NOW + timedelta(seconds=number // 3), act=f"act.{number % 2}", subject="scan"
            )
            for number in range(count)
        ]
        session.add_all(rows)
        ordered = sorted(rows, key=lambda row: (row.time, str(row.id)), reverse=True)
        return [row.id for row in ordered]


def read_all(session: Session, query: Any, order: Any, limit: int, **options: bool) -> list[Any]:
    seen, cursor = [], None
    while True:
        rows, cursor = fetch_page(session, query, order, cursor, limit, **options)
        assert len(rows) <= limit
        seen += rows
        if cursor is None:
            return seen


@pytest.mark.parametrize("limit", [1, 2, 3, 10, 11])
def test_rows_of_the_same_moment_come_once_each_however_long_the_pages_are(database: Database, limit: int) -> None:
    expected = add_lines(database, 10)
    with database.reading() as session:
        query, order = select(AuditRow), (AuditRow.time, AuditRow.id)
        falling = [row.id for row in read_all(session, query, order, limit)]
        rising = [row.id for row in read_all(session, query, order, limit, is_falling=False)]
    assert falling == expected and rising == expected[::-1]


def test_a_page_that_ends_with_the_list_names_no_next_one(database: Database) -> None:
    add_lines(database, 4)
    with database.reading() as session:
        rows, cursor = fetch_page(session, select(AuditRow), (AuditRow.time, AuditRow.id), None, 4)
    assert len(rows) == 4 and cursor is None


def test_a_query_of_several_things_gives_tuples_without_what_it_is_ordered_by(database: Database) -> None:
    add_lines(database, 3)
    with database.reading() as session:
        query = select(AuditRow.act, AuditRow.subject)
        rows, cursor = fetch_page(session, query, (AuditRow.time, AuditRow.id), None, 2)
    assert all(len(row) == 2 and row[1] == "scan" for row in rows) and cursor is not None


def test_groups_are_paged_by_what_is_computed_of_them(database: Database) -> None:
    add_lines(database, 9)
    with database.reading() as session:
        query = select(AuditRow.time).group_by(AuditRow.time)
        counted = read_all(session, query, (func.count(AuditRow.id), AuditRow.time), 2)
    assert counted == [NOW + timedelta(seconds=number) for number in (2, 1, 0)]


def test_names_are_paged_without_regard_to_case(database: Database) -> None:
    with database.writing() as session:
        session.add_all([Account(name=name) for name in ("berta", "Anna", "CARLA", "anton")])
    with database.reading() as session:
        query = select(Account.name).where(Account.name != "local")
        names = read_all(session, query, (func.lower(Account.name), Account.id), 1, is_falling=False)
    assert names == ["Anna", "anton", "berta", "CARLA"]


@pytest.mark.parametrize(
    "cursor",
    [
        "AAAA",
        write_cursor("yesterday", str(uuid.uuid4())),
        write_cursor("2026-01-02T03:04:05", str(uuid.uuid4())),
        write_cursor(NOW.isoformat(), "17"),
        write_cursor(NOW.isoformat()),
        write_cursor(17, str(uuid.uuid4())),
    ],
    ids=["no JSON", "no moment", "no zone", "no id", "too short", "a number"],
)
def test_a_cursor_of_another_list_is_refused(database: Database, cursor: str) -> None:
    with database.reading() as session, pytest.raises(UnknownCursorError, match="is not valid"):
        fetch_page(session, select(AuditRow), (AuditRow.time, AuditRow.id), cursor, 5)


@pytest.mark.parametrize("place", [(2**31,), (float("nan"),), ("a\0b",), ("\ud800",)])
def test_what_no_database_compares_is_refused(place: tuple[Any, ...]) -> None:
    with pytest.raises(UnknownCursorError):
        read_cursor(write_cursor(*place), type(place[0]))


def test_a_cursor_is_read_as_it_was_written() -> None:
    assert read_cursor(write_cursor("cam0", 17, 0.25), str, int, float) == ["cam0", 17, 0.25]
