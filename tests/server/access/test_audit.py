"""The audit trail: a line with each act or neither, found by who, what and on which thing, the newest first."""

from __future__ import annotations

import uuid
from datetime import timedelta
from typing import Any

import pytest
from sqlalchemy import select

from server.access.audit import AuditFilter, list_acts, record_act
from server.access.models import AuditRow
from server.database import Database, utc_now
from tests.server.rows import keep, make_person

NOW = utc_now()


@pytest.fixture
def database_kind() -> str:
    return "sqlite"


def find(database: Database, **which: Any) -> list[str]:
    with database.reading() as session:
        return [row.act for row in list_acts(session, AuditFilter(**which), None, 100)[0]]


def test_an_act_that_fails_leaves_no_line(database: Database) -> None:
    ann, thing = make_person("ann"), uuid.uuid4()
    keep(database, ann)
    with database.writing() as session:
        record_act(session, ann.id, "scan.delete", "scan", thing, name="hand", count=3)

    def fail() -> None:
        with database.writing() as session:
            record_act(session, ann.id, "scan.erase", "scan", thing)
            raise LookupError("no such scan")

    with pytest.raises(LookupError):
        fail()
    with database.reading() as session:
        [line] = session.scalars(select(AuditRow))
    assert (line.act, line.subject, line.subject_id, line.account_id) == ("scan.delete", "scan", thing, ann.id)
    assert line.detail == {"name": "hand", "count": 3} and abs(line.time - utc_now()) < timedelta(minutes=1)


def test_lines_are_found_by_each_thing_and_by_all_together(database: Database) -> None:
    ann, bob, thing = make_person("ann"), make_person("bob"), uuid.uuid4()
    lines = [
        (ann.id, "assignment.submit", "assignment", thing),
        (bob.id, "assignment.accept", "assignment", thing),
        (bob.id, "assignments.export", "project", None),
        (None, "account.code", "account", ann.id),
        (ann.id, "assignment", "project", None),
    ]
    rows = [
        AuditRow(time=NOW - timedelta(minutes=n), account_id=who, act=act, subject=subject, subject_id=what)
        for n, (who, act, subject, what) in enumerate(lines)
    ]
    keep(database, ann, bob, *reversed(rows))
    assert find(database) == [act for _, act, _, _ in lines]
    assert find(database, act="assignment") == ["assignment.submit", "assignment.accept", "assignment"]
    assert find(database, act="assignment.accept") == ["assignment.accept"]
    assert find(database, account_id=bob.id) == ["assignment.accept", "assignments.export"]
    assert find(database, subject="project") == ["assignments.export", "assignment"]
    assert find(database, subject_id=thing, account_id=ann.id) == ["assignment.submit"]
    assert find(database, subject_id=thing, act="account") == []


@pytest.mark.parametrize("act", ["assign%", "assignm_nt", "%", ""])
def test_signs_that_mean_something_to_a_database_mean_themselves(database: Database, act: str) -> None:
    keep(database, AuditRow(act="assignment.submit", subject="assignment"))
    assert find(database, act=act) == []


def test_lines_of_one_moment_come_once_each_over_pages(database: Database) -> None:
    keep(database, *(AuditRow(time=NOW, act=f"act.{n}", subject="x") for n in range(7)))
    found, cursor = [], None
    with database.reading() as session:
        while True:
            rows, cursor = list_acts(session, AuditFilter(act="act"), cursor, 3)
            found += [row.act for row in rows]
            if cursor is None:
                break
    assert len(found) == 7 and set(found) == {f"act.{n}" for n in range(7)}
