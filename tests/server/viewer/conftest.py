"""One studio for all of these tests: starting the viewer process takes seconds, a session in it does not."""

from __future__ import annotations

import shutil
import uuid
from collections.abc import Iterator
from pathlib import Path

import pytest
from fastapi.testclient import TestClient

from server.access.models import LOCAL_ACCOUNT_ID
from server.app import create_app
from server.imports.service import ImportContext, import_recording
from server.settings import Settings
from server.tracks.service import add_track
from tests.server.conftest import BASE_URL, Studio, Tracked


@pytest.fixture(scope="module")
def studio(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Studio]:
    settings = Settings(data_dir=tmp_path_factory.mktemp("studio"))
    app = create_app(settings)
    with TestClient(app, base_url=BASE_URL, raise_server_exceptions=False) as client:
        yield Studio(app, client, settings)


@pytest.fixture(scope="module")
def client(studio: Studio) -> TestClient:
    return studio.client


@pytest.fixture(scope="module")
def tracked(studio: Studio, rendered: Path, tracked_folder: Path) -> Tracked:
    storage, track_id = studio.app.state.storage, uuid.uuid4()
    desk = ImportContext(studio.database, storage, studio.settings)
    sequence_id = import_recording(desk, rendered, {}, LOCAL_ACCOUNT_ID)
    shutil.copytree(tracked_folder, storage.folder("tracks", track_id))
    with studio.database.writing() as session:
        add_track(session, storage.folder("tracks", track_id), track_id, sequence_id, None)
    return Tracked(sequence_id, track_id)
