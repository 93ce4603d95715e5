"""A studio that commands find by the environment, with its tables made already."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import pytest

from server.cli.open_studio import OpenStudio
from server.database import Database
from server.settings import Settings
from server.storage import Storage


@pytest.fixture
def own_studio(sqlite_settings: Settings, monkeypatch: pytest.MonkeyPatch) -> Iterator[OpenStudio]:
    """On SQLite; what the commands see too."""
    monkeypatch.setenv("HANDLOOM_DATA_DIR", str(sqlite_settings.data_dir))
    monkeypatch.setenv("HANDLOOM_DATABASE_URL", str(sqlite_settings.database_url))
    with closing(Database(sqlite_settings.sqlalchemy_url)) as database:
        yield OpenStudio(sqlite_settings, database, Storage(Path(sqlite_settings.data_dir)))
