"""The studio's data, opened by a command without a web server."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING

from server.cli.guarded import load_settings

if TYPE_CHECKING:
    from server.database import Database
    from server.settings import Settings
    from server.storage import Storage


@dataclass(frozen=True)
class OpenStudio:
    """Settings, tables and files of a studio."""

    settings: Settings
    database: Database
    storage: Storage


@contextmanager
def open_studio(settings: Settings | None = None) -> Iterator[OpenStudio]:
    """Open it, with its tables up to date; a studio that runs at the same time is not disturbed."""
    from server.database import Database
    from server.database.migrate import upgrade
    from server.storage import open_storage

    settings = settings or load_settings()
    storage = open_storage(settings)
    database = Database(settings.sqlalchemy_url)
    try:
        upgrade(database)
        yield OpenStudio(settings, database, storage)
    finally:
        database.close()
