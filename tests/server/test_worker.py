"""Where a worker's queue keeps its tables: beside the studio's files, or in the studio's own PostgreSQL."""

from __future__ import annotations

from pathlib import Path

import pytest
from sqlalchemy import make_url

from server.settings import Settings
from server.worker import find_system_database


@pytest.mark.parametrize("url", [None, "sqlite:////elsewhere/own.sqlite3"])
def test_beside_sqlite_it_is_a_file_of_its_own_in_the_data_folder(tmp_path: Path, url: str | None) -> None:
    found = find_system_database(Settings(data_dir=tmp_path, database_url=url))
    assert found == f"sqlite:///{tmp_path / 'dbos.sqlite'}"
    assert make_url(found).database == str(tmp_path / "dbos.sqlite")


@pytest.mark.parametrize("scheme", ["postgresql", "postgres"])
def test_in_postgresql_it_is_the_studios_own_with_its_password_and_options(tmp_path: Path, scheme: str) -> None:
    address = "://ann:p%40ss@db.lab:5433/studio?sslmode=require"
    found = find_system_database(Settings(data_dir=tmp_path, database_url=scheme + address))
    assert found == "postgresql" + address
    assert make_url(found).password == "p@ss"
