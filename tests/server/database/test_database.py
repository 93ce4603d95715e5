"""Sessions and types."""

from __future__ import annotations

import sqlite3
import threading
import uuid
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from datetime import UTC, datetime, timedelta, timezone
from pathlib import Path

import pytest
from sqlalchemy import select, text

from server.access.models import Account
from server.database import Database


def test_a_moment_comes_back_in_utc_with_its_zone(database: Database) -> None:
    moment = datetime(2026, 1, 2, 3, 4, 5, 678901, tzinfo=timezone(timedelta(hours=5)))
    with database.writing() as session:
        session.add(Account(name="anna", created_at=moment))
    with database.reading() as session:
        found = session.scalars(select(Account).where(Account.name == "anna")).one()
    assert found.created_at == moment
    assert found.created_at.tzinfo is UTC


def test_nothing_is_kept_of_a_session_that_raises(database: Database) -> None:
    def fail() -> None:
        with database.writing() as session:
            session.add(Account(name="anna"))
            session.flush()
            raise RuntimeError

    with pytest.raises(RuntimeError):
        fail()
    with database.reading() as session:
        assert session.scalars(select(Account).where(Account.name == "anna")).all() == []


def test_readers_are_not_held_up_by_a_writer(database: Database) -> None:
    with database.writing() as writer:
        writer.add(Account(name="anna"))
        writer.flush()
        with database.reading() as reader:
            assert reader.scalars(select(Account).where(Account.name == "anna")).all() == []


def test_writers_that_read_first_wait_for_each_other_instead_of_failing(database: Database) -> None:
    barrier = threading.Barrier(8)

    def write(number: int) -> None:
        barrier.wait()
        for step in range(5):
            with database.writing() as session:
                session.scalars(select(Account)).all()
                session.add(Account(name=f"{number}-{step}"))

    with ThreadPoolExecutor(8) as pool:
        list(pool.map(write, range(8)))
    with database.reading() as session:
        assert len(session.scalars(select(Account)).all()) == 41


def test_sqlite_keeps_every_commit_and_checks_references(tmp_path: Path) -> None:
    with closing(Database(f"sqlite:///{tmp_path}/new/folder/test.sqlite3")) as database, database.reading() as session:
        assert session.scalar(text("PRAGMA journal_mode")) == "wal"
        assert session.scalar(text("PRAGMA synchronous")) == 2
        assert session.scalar(text("PRAGMA foreign_keys")) == 1
        assert session.scalar(text("PRAGMA busy_timeout")) == 15_000


def test_a_reference_to_nothing_is_refused(database: Database) -> None:
    with pytest.raises(Exception, match=r"(?i)foreign key"), database.writing() as session:
        session.execute(
            text("INSERT INTO annotation_revisions VALUES (:a, :b, 1, :c, 'put', NULL, :d, NULL, NULL)"),
            {"a": uuid.uuid4().hex, "b": uuid.uuid4().hex, "c": uuid.uuid4().hex, "d": datetime.now(UTC).isoformat()},
        )


def test_a_new_file_in_which_another_process_writes_is_waited_for(tmp_path: Path) -> None:
    other = sqlite3.connect(tmp_path / "new.sqlite3", isolation_level=None, check_same_thread=False)
    other.execute("BEGIN IMMEDIATE")  # SQLite refuses to switch the file to WAL now, at once
    database = Database(f"sqlite:///{tmp_path / 'new.sqlite3'}")
    release = threading.Timer(0.3, other.execute, ("ROLLBACK",))
    release.start()
    with database.reading() as session:
        assert session.scalar(text("PRAGMA journal_mode")) == "wal"
    release.join()
    database.close()
    other.close()
