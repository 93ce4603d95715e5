"""A studio with a real client and a real database, once on SQLite and once on PostgreSQL."""

from __future__ import annotations

import argparse
import json
import logging
import shutil
import uuid
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import psycopg
import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient

from server.access.models import LOCAL_ACCOUNT_ID
from server.app import create_app
from server.database import Database
from server.database.migrate import upgrade
from server.imports.service import ImportContext, import_recording
from server.settings import Settings
from server.storage import Storage
from server.tracks.service import add_track
from tests.once import make_once
from tests.postgres import NoPostgresError, run_postgres
from tracker import (
    Registrar,
    Registration,
    Scan,
    TrackOptions,
    add_commands,
    join_chunks,
    load_annotations,
    load_registration,
    load_sequence,
    save_registration,
    start_tracking,
    track_frames,
    untrained_hand,
)
from tracker.capture.scan import load_scan, save_scan

MakeRecording = Callable[..., Path]
BASE_URL = "http://127.0.0.1:8000"


@pytest.fixture(scope="session")
def postgres_url() -> Iterator[str]:
    """A PostgreSQL server of this test run, without fsync; skipped with a line where none can be started."""
    try:
        with run_postgres(is_durable=False) as url:
            yield url
    except NoPostgresError as problem:
        pytest.skip(str(problem))


@dataclass(frozen=True)
class S3:
    """An S3-compatible store of this test run."""

    endpoint: str
    environment: dict[str, str]
    """Keys, as the usual variables name them."""


@pytest.fixture(scope="session")
def s3_server() -> Iterator[S3]:
    """A real HTTP server that speaks S3, on this machine."""
    from moto.server import ThreadedMotoServer

    logging.getLogger("werkzeug").setLevel(logging.WARNING)  # a line for each request otherwise
    server = ThreadedMotoServer(ip_address="127.0.0.1", port=0, verbose=False)
    server.start()
    host, port = server.get_host_and_port()
    environment = {
        "AWS_ACCESS_KEY_ID": "handloom",
        "AWS_SECRET_ACCESS_KEY": "not-secret-at-all",
        "AWS_DEFAULT_REGION": "us-east-1",
    }
    yield S3(f"http://{host}:{port}", environment)
    server.stop()


@pytest.fixture
def s3(s3_server: S3, monkeypatch: pytest.MonkeyPatch) -> S3:
    """The store, with its keys in the environment."""
    for name, value in s3_server.environment.items():
        monkeypatch.setenv(name, value)
    return s3_server


@pytest.fixture(params=["sqlite", "postgresql"])
def database_kind(request: pytest.FixtureRequest) -> str:
    """Every test that uses a database runs on both kinds, some of them on PostgreSQL with `make proofs` only."""
    return request.param


POSTGRESQL_IN_PROOFS = {
    "app", "bodies", "calibrations", "client", "evaluations", "exchange", "hand_models", "imports", "lineage",
    "moving_scans", "quality", "refinements", "registrations", "scans", "sequences", "suggestions", "tracks",
    "training_sets",
}  # fmt: skip
"""Rooms that read more than they write. Where many write at once (labels, jobs, people), `make test` has both."""


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    for item in items:
        is_postgresql = getattr(getattr(item, "callspec", None), "params", {}).get("database_kind") == "postgresql"
        if is_postgresql and item.path.parent.name in POSTGRESQL_IN_PROOFS:
            item.add_marker(pytest.mark.slow)


@contextmanager
def _make_postgres_database(server: str, template: str) -> Iterator[str]:
    name = f"test_{uuid.uuid4().hex}"
    with psycopg.connect(f"{server}/postgres", autocommit=True) as connection:
        connection.execute(f'CREATE DATABASE "{name}" TEMPLATE "{template}"')
        yield f"{server}/{name}"
        connection.execute(f'DROP DATABASE "{name}" WITH (FORCE)')


@pytest.fixture
def empty_database_url(database_kind: str, request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[str]:
    """A database without tables."""
    if database_kind == "sqlite":
        yield f"sqlite:///{tmp_path}/empty.sqlite3"
        return
    with _make_postgres_database(request.getfixturevalue("postgres_url"), "template0") as url:
        yield url


@pytest.fixture(scope="session")
def sqlite_template(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A file with all tables, to be copied: quicker than to migrate for every test."""
    path = tmp_path_factory.mktemp("template") / "template.sqlite3"
    with closing(Database(f"sqlite:///{path}")) as database:
        upgrade(database)
    return path


@pytest.fixture
def sqlite_settings(sqlite_template: Path, tmp_path: Path) -> Settings:
    """Settings of a studio of its own on SQLite, with all tables."""
    path = tmp_path / "test.sqlite3"
    shutil.copy(sqlite_template, path)
    return Settings(data_dir=tmp_path / "data", database_url=f"sqlite:///{path}")


@pytest.fixture(scope="session")
def postgres_template(postgres_url: str) -> str:
    """Name of a database with all tables, to be copied."""
    with psycopg.connect(f"{postgres_url}/postgres", autocommit=True) as connection:
        connection.execute("CREATE DATABASE migrated")
    with closing(Database(Settings(database_url=f"{postgres_url}/migrated").sqlalchemy_url)) as database:
        upgrade(database)
    return "migrated"


@pytest.fixture
def settings(database_kind: str, request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Settings]:
    """Settings of a studio of its own, with all tables."""
    data_dir = tmp_path / "data"
    if database_kind == "sqlite":
        path = tmp_path / "test.sqlite3"
        shutil.copy(request.getfixturevalue("sqlite_template"), path)
        yield Settings(data_dir=data_dir, database_url=f"sqlite:///{path}")
        return
    template = request.getfixturevalue("postgres_template")
    with _make_postgres_database(request.getfixturevalue("postgres_url"), template) as url:
        yield Settings(data_dir=data_dir, database_url=url)


@pytest.fixture
def empty_database(empty_database_url: str) -> Iterator[Database]:
    """A database without tables, opened."""
    with closing(Database(Settings(database_url=empty_database_url).sqlalchemy_url)) as database:
        yield database


@pytest.fixture
def database(settings: Settings) -> Iterator[Database]:
    """A database with all tables, opened."""
    with closing(Database(settings.sqlalchemy_url)) as database:
        yield database


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


@pytest.fixture
def make_recording(tmp_path: Path) -> MakeRecording:
    """Writes a small recording folder: one RGB-D camera, or colour alone, or depth alone."""

    def make(
        name: str = "waving",
        frames: int = 3,
        color: str | None = "png",
        depth: bool = True,
        size: tuple[int, int] = (32, 24),
    ) -> Path:
        folder = tmp_path / "recordings" / name
        folder.mkdir(parents=True)
        width, height = size
        rng = np.random.default_rng(7)
        camera = {
            "id": "cam0",
            "width": width,
            "height": height,
            "K": [[float(width), 0, width / 2], [0, float(width), height / 2], [0, 0, 1]],
            "distortion": [],
            "T_world_camera": np.eye(4).tolist(),
        }
        if color:
            camera["color"] = f"color/{{:06d}}.{color}"
            (folder / "color").mkdir()
        if depth:
            camera |= {"depth": "depth/{:06d}.png", "depth_scale": 0.001}
            (folder / "depth").mkdir()
        for index in range(frames):
            if color:
                image = rng.integers(0, 255, (height, width, 3), dtype=np.uint8)
                cv2.imwrite(str(folder / "color" / f"{index:06d}.{color}"), image)
            if depth:
                values = rng.integers(400, 800, (height, width), dtype=np.uint16)
                values[0, 0] = 0
                cv2.imwrite(str(folder / "depth" / f"{index:06d}.png"), values)
        document = {
            "version": 1,
            "name": name,
            "fps": 30.0,
            "frame_count": frames,
            "cameras": [camera],
            "hands": ["right"],
        }
        (folder / "sequence.json").write_text(json.dumps(document | {"objects": []}))
        return folder

    return make


AddRecording = Callable[..., dict[str, Any]]


@pytest.fixture
def add_recording(studio: Studio, make_recording: MakeRecording) -> AddRecording:
    """Puts a small recording into the studio; gives it as the API does."""

    def add(name: str = "waving", **arguments: Any) -> dict[str, Any]:
        desk = ImportContext(studio.database, studio.app.state.storage, studio.settings)
        id_ = import_recording(desk, make_recording(name, **arguments), {}, LOCAL_ACCOUNT_ID)
        return studio.client.get(f"/api/v1/sequences/{id_}").json()

    return add


RENDERED_FRAMES = 45
"""Two chunks of a job and a bit."""


@pytest.fixture(scope="session")
def rendered(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A recording folder that Handloom rendered itself: a right hand that opens and closes, every frame annotated."""
    parser = argparse.ArgumentParser()
    add_commands(parser.add_subparsers())
    command = ["synthesize", "--motion", "open-close", "--frames", f"0:{RENDERED_FRAMES}", "--out"]

    def render(folder: Path) -> None:
        args = parser.parse_args([*command, str(folder / "recording")])
        assert args.run(args) == 0

    return make_once(tmp_path_factory, "rendered", render) / "recording"


@dataclass(frozen=True)
class GeneratedHand:
    """A scan with its registration, on disk."""

    scan: Scan
    found: Registration
    folder: Path


@pytest.fixture(scope="session")
def generated_hand(tmp_path_factory: pytest.TempPathFactory) -> GeneratedHand:
    """A scan of few points, `hand.ply`, registered once for all tests."""
    folder = make_once(tmp_path_factory, "generated-hand", _register_hand)
    return GeneratedHand(load_scan(folder / "hand.ply"), load_registration(folder), folder)


def _register_hand(folder: Path) -> None:
    from tracker.synthesis.scans.generate import ScanOptions, generate_scan
    from tracker.synthesis.scans.scanner import Scanner

    options = ScanOptions(scanner=Scanner(num_points=3000), has_forearm=False)
    save_scan(generate_scan(3, 0, "right", 5, options).scan, folder / "hand.ply")
    save_registration(Registrar(untrained_hand("right")).register(load_scan(folder / "hand.ply")), folder)


@pytest.fixture(scope="session")
def tracked_folder(rendered: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A track of the first frames of `rendered`."""

    def track(folder: Path) -> None:
        sequence, frames = load_sequence(rendered), range(12)
        options = TrackOptions(calibrate=False, last_frame=frames[-1])
        setup, state = start_tracking(sequence, options, None, load_annotations(rendered / "annotations.json"))
        join_chunks(sequence, setup, [track_frames(sequence, setup, state, frames)[1]]).save(folder)

    return make_once(tmp_path_factory, "tracked", track)


@dataclass
class Tracked:
    """A recording in a studio, and a track of it."""

    sequence_id: uuid.UUID
    track_id: uuid.UUID


@pytest.fixture
def tracked(studio: Studio, rendered: Path, tracked_folder: Path) -> Tracked:
    storage: Storage = studio.app.state.storage
    desk = ImportContext(studio.database, storage, studio.settings)
    sequence_id = import_recording(desk, rendered, {}, LOCAL_ACCOUNT_ID)
    track_id = uuid.uuid4()
    shutil.copytree(tracked_folder, storage.folder("tracks", track_id))
    with studio.database.writing() as session:
        add_track(session, storage.folder("tracks", track_id), track_id, sequence_id, None)
    return Tracked(sequence_id, track_id)
