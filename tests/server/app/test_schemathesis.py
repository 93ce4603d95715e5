"""Every route fed with requests made from the OpenAPI document: all checks of schemathesis find nothing.

`schemathesis.toml` names the few rules that no schema can hold. What it excepts counts here too.
"""

from __future__ import annotations

import json
import os
import shutil
import socket
import subprocess
import sys
import time
import uuid
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import httpx
import pytest
import schemathesis
from fastapi import FastAPI
from hypothesis import HealthCheck, Phase, given, settings
from schemathesis.checks import CHECKS, load_all_checks
from schemathesis.config import SchemathesisConfig
from schemathesis.python.asgi import get_client, shutdown_lifespans
from sqlalchemy import update

from server.accounts.models import LOCAL_ACCOUNT_ID, Account
from server.accounts.tries import FailedTries
from server.app import create_app
from server.app.openapi import write_document
from server.hand_models.models import HandModelRow
from server.imports.service import ImportDesk, import_recording
from server.scans.models import ScanRow
from server.sequences.models import SequenceRow
from server.settings import Settings
from server.storage import Storage
from server.tracks.models import TrackRow
from server.tracks.service import add_track
from tests.server.conftest import BASE_URL, GeneratedHand
from tests.server.curation import add_curation

EXAMPLES = 8
"""Of each route; all routes together take less than a minute."""

DOCUMENT = json.loads(write_document())


ROOT = Path(__file__).parents[3]
EXCEPTIONS = SchemathesisConfig.from_path(ROOT / "schemathesis.toml")

load_all_checks()
ENDLESS = frozenset({"/api/v1/jobs/events", "/api/v1/jobs/{job_id}/events"})
"""Streams do not end, so no client of this kind can read them; `tests/server/jobs/test_events.py` does."""

REQUESTS = [(method, path) for path, item in DOCUMENT["paths"].items() for method in item if path not in ENDLESS]


@dataclass
class Fed:
    """A studio that holds a recording, annotations, a track and somebody: requests get past "no such thing"."""

    app: FastAPI
    schema: Any
    known: dict[str, Any]

    def mend(self) -> None:
        """Undo what requests before have deleted or shut."""
        with self.app.state.database.writing() as session:
            session.execute(update(SequenceRow).values(deleted_at=None))
            session.execute(update(TrackRow).values(deleted_at=None))
            session.execute(update(ScanRow).values(deleted_at=None))
            session.execute(update(HandModelRow).values(deleted_at=None))
        self.app.state.failed_tries = FailedTries()


@pytest.fixture(scope="module")
def fed(
    rendered: Path,
    tracked_folder: Path,
    generated_hand: GeneratedHand,
    tmp_path_factory: pytest.TempPathFactory,
) -> Iterator[Fed]:
    app = create_app(Settings(data_dir=tmp_path_factory.mktemp("fed"), max_upload_bytes=200_000))
    with get_client(app) as client:
        storage: Storage = app.state.storage
        desk = ImportDesk(app.state.database, storage, app.state.settings)
        sequence_id, track_id = import_recording(desk, rendered, {}, LOCAL_ACCOUNT_ID), uuid.uuid4()
        shutil.copytree(tracked_folder, storage.folder("tracks", track_id))
        with app.state.database.writing() as session:
            add_track(session, storage.folder("tracks", track_id), track_id, sequence_id, None)
            account = Account(name="Anna")
            session.add(account)
        recording = client.get(f"{BASE_URL}/api/v1/sequences/{sequence_id}").json()
        job = {"kind": "track", "sequence_id": str(sequence_id), "params": {}}
        known = {
            "sequence_id": str(sequence_id),
            "track_id": str(track_id),
            "account_id": str(account.id),
            "content_key": recording["content_key"],
            "camera": recording["cameras"][0]["id"],
            "frame": 3,
            "hand": "right",
            "revision": 1,
            "job_id": client.post(f"{BASE_URL}/api/v1/jobs", json=job).json()["id"],
            "project_id": client.post(f"{BASE_URL}/api/v1/projects", json={"name": "fed"})
            .json()
            .get("id", str(uuid.uuid4())),
        }
        known |= add_curation(app, generated_hand, LOCAL_ACCOUNT_ID)
        schema = schemathesis.openapi.from_dict(app.openapi(), config=EXCEPTIONS)
        schema.app = app
        yield Fed(app, schema, known)
    shutdown_lifespans()


@pytest.mark.parametrize(("method", "path"), REQUESTS, ids=[f"{method} {path}" for method, path in REQUESTS])
def test_no_request_breaks_the_studio_or_its_promises(fed: Fed, method: str, path: str) -> None:
    fed.mend()
    operation = fed.schema[path][method.upper()]
    turn = 0

    @settings(
        max_examples=EXAMPLES,
        deadline=None,
        database=None,
        derandomize=True,
        phases=[Phase.generate],
        suppress_health_check=list(HealthCheck),
    )
    @given(case=operation.as_strategy())
    def feed(case: schemathesis.Case) -> None:
        nonlocal turn
        turn += 1
        if turn % 4:  # three of four requests are about things that are there
            for name in case.path_parameters or {}:
                if name in fed.known:
                    case.path_parameters[name] = fed.known[name]
        answer = case.call(base_url=BASE_URL)
        case.validate_response(answer, checks=CHECKS.get_all())

    feed()


def _serve(data_dir: Path, **more: str) -> tuple[subprocess.Popen[bytes], str]:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    environment = os.environ | {"HANDLOOM_DATA_DIR": str(data_dir)} | more
    process = subprocess.Popen(
        [sys.executable, "-m", "server.cli", "serve", "--port", str(port)], cwd=ROOT, env=environment
    )
    url = f"http://127.0.0.1:{port}/api/v1"
    for _ in range(600):
        try:
            if httpx.get(f"{url}/health").is_success:
                return process, url
        except httpx.HTTPError:
            time.sleep(0.2)
    process.kill()
    raise AssertionError("the studio was not up within two minutes")


@pytest.mark.slow
@pytest.mark.parametrize("login", ["auto", "required"])
def test_the_command_schemathesis_finds_nothing_in_a_served_studio(login: str, tmp_path: Path) -> None:
    """All checks and all phases against the real server, for one person and where people log in."""
    process, url = _serve(tmp_path, **({"HANDLOOM_LOGIN": "required"} if login == "required" else {}))
    try:
        command = [str(Path(sys.executable).with_name("schemathesis")), "run", f"{url}/openapi.json", "--checks", "all"]
        if login == "required":  # the document itself is behind the login
            command[2:3] = [str(ROOT / "web" / "src" / "api" / "openapi.json"), "--url", url.removesuffix("/api/v1")]
        more = ["--max-examples", "20", "--continue-on-failure", "--no-shrink", "--warnings", "off"]
        done = subprocess.run([*command, *more], cwd=ROOT, capture_output=True, text=True)
    finally:
        process.terminate()
        process.wait(30)
    assert done.returncode == 0, done.stdout[-8000:]
