"""Alembic without its command line: the same from a clone and from an installed package."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from functools import cache
from pathlib import Path
from typing import Any

from alembic import command
from alembic.config import Config
from alembic.runtime.migration import MigrationContext
from alembic.script import ScriptDirectory
from sqlalchemy import Connection, text

from server.database.database import Database

SERVER = Path(__file__).resolve().parents[1]
PACKAGED = SERVER / "migrations"
"""Where a wheel carries them."""
SCRIPTS = PACKAGED if PACKAGED.is_dir() else SERVER.parent / "migrations"
LOCK = 0x68616E646C6F6F6D
"""PostgreSQL's advisory lock of a migration; spells `handloom`."""


def upgrade(database: Database, revision: str = "head") -> None:
    """Bring the tables to a revision, in one transaction. Processes that start together wait for the first."""
    with database.engine.connect() as connection:
        if find_current(connection) == (find_head() if revision == "head" else revision):
            return
    _run(database, lambda config: command.upgrade(config, revision))


def downgrade(database: Database, revision: str) -> None:
    """Take the tables back to a revision, in one transaction; `base` leaves none."""
    _run(database, lambda config: command.downgrade(config, revision))


@cache
def find_head() -> str:
    """The newest revision there is."""
    head = ScriptDirectory.from_config(_config()).get_current_head()
    assert head is not None
    return head


def find_current(connection: Connection) -> str | None:
    """The revision of a database; None when it has no tables yet."""
    return MigrationContext.configure(connection).get_current_revision()


def _config() -> Config:
    assert (SCRIPTS / "env.py").is_file(), f"no migrations at {SCRIPTS}"
    config = Config()
    config.set_main_option("script_location", str(SCRIPTS).replace("%", "%%"))
    return config


def _run(database: Database, migrate: Callable[[Config], None]) -> None:
    config = _config()
    with (
        database.engine.connect().execution_options(is_writing=True) as connection,
        _without_foreign_keys(connection) if database.is_sqlite else nullcontext(),
        connection.begin(),
    ):
        if not database.is_sqlite:
            connection.execute(text("SELECT pg_advisory_xact_lock(:key)"), {"key": LOCK})
        config.attributes["connection"] = connection
        migrate(config)
        if database.is_sqlite and (broken := connection.execute(text("PRAGMA foreign_key_check")).first()):
            raise RuntimeError(f"The migration would leave a row that names a missing one: {tuple(broken)}.")


@contextmanager
def _without_foreign_keys(connection: Connection) -> Iterator[None]:
    """SQLite changes a table by making another in its place, which would take the rows that name it for orphans.

    The switch does nothing inside a transaction.
    """
    raw: Any = connection.connection.dbapi_connection
    raw.execute("PRAGMA foreign_keys = OFF")
    try:
        yield
    finally:
        raw.execute("PRAGMA foreign_keys = ON")
