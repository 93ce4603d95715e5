"""Every route fed with requests made from the OpenAPI document: all checks of schemathesis find nothing.

`schemathesis.toml` names the few rules that no schema can hold. What it excepts counts here too.
"""

from __future__ import annotations

import shutil
import sqlite3
from collections.abc import Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
import schemathesis
from fastapi import FastAPI
from fastapi.testclient import TestClient
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis.errors import Unsatisfiable
from schemathesis import GenerationMode
from schemathesis.checks import CHECKS, load_all_checks
from schemathesis.config import SchemathesisConfig
from schemathesis.python.asgi import get_client, shutdown_lifespans

from server.access.login_throttle import LoginThrottle
from server.app import create_app
from server.settings import Settings
from tests.server.api_document import read_document
from tests.server.app.full_studio import LEFT_OUT, Known, Sender, fill
from tests.server.conftest import BASE_URL, GeneratedHand

pytestmark = pytest.mark.slow

FILE = "handloom.sqlite3"

EXAMPLES = {GenerationMode.POSITIVE: 4, GenerationMode.NEGATIVE: 2}
"""Requests to each route, right ones and wrong ones; all routes together take less than a minute."""

DOCUMENT = read_document()
ROOT = Path(__file__).parents[3]
EXCEPTIONS = ROOT / "schemathesis.toml"

load_all_checks()
ENDLESS = ("/events", "/live")
"""How addresses of event streams end. They never do, so no client of this kind can read them; tests of their own do."""

REQUESTS = [(method, path) for path, item in DOCUMENT["paths"].items() if not path.endswith(ENDLESS) for method in item]


@dataclass
class Fed:
    """A full studio, and how to bring it back to what it was."""

    app: FastAPI
    client: TestClient
    schema: Any
    known: Known
    kept: Path

    def mend(self) -> None:
        """Undo what requests before have changed or deleted."""
        data_dir = self.app.state.settings.data_dir
        with (
            closing(sqlite3.connect(self.kept / FILE)) as kept,
            closing(sqlite3.connect(data_dir / FILE, timeout=30)) as live,
        ):
            kept.backup(live)
        shutil.copytree(self.kept / "uploads", data_dir / "uploads", dirs_exist_ok=True)
        self.app.state.login_throttle = LoginThrottle()

    def fill_in(self, case: schemathesis.Case) -> None:
        """Put what is there in the place of made-up names."""
        known = self.known.find(case.path)
        for part in (case.path_parameters, case.query, case.body):
            if isinstance(part, dict):
                for name in part.keys() & known.keys():
                    part[name] = known[name]
                    if known[name] is LEFT_OUT:
                        del part[name]
        if "if-match" in case.headers:
            parts = case.path.format(**case.path_parameters).split("/")
            answers = (self.client.get("/".join(parts[:end])) for end in range(len(parts), 4, -1))
            tag = next((answer.headers["etag"] for answer in answers if "etag" in answer.headers), None)
            case.headers["if-match"] = tag or '"1"'
            case.headers.pop("if-none-match", None)


@contextmanager
def _open(data_dir: Path) -> Iterator[tuple[FastAPI, Any, TestClient]]:
    """A studio in this process, its document as schemathesis reads it, and a client."""
    app = create_app(Settings(data_dir=data_dir, max_upload_bytes=5_000_000))
    schema = schemathesis.openapi.from_dict(app.openapi(), config=SchemathesisConfig.from_path(EXCEPTIONS))
    schema.app = app
    with get_client(app) as client:
        client.base_url = BASE_URL
        yield app, schema, client
    shutdown_lifespans()


def _sender(schema: Any, client: TestClient) -> Sender:
    return Sender(client, lambda method, path, answer: schema[path][method].validate_response(answer))


@pytest.fixture(scope="module")
def fed(
    rendered: Path,
    tracked_folder: Path,
    generated_hand: GeneratedHand,
    tmp_path_factory: pytest.TempPathFactory,
) -> Iterator[Fed]:
    kept, data_dir = tmp_path_factory.mktemp("kept"), tmp_path_factory.mktemp("fed")
    with _open(data_dir) as (app, schema, client):
        known = fill(app, _sender(schema, client), rendered, tracked_folder, generated_hand)
        with closing(sqlite3.connect(data_dir / FILE)) as live, closing(sqlite3.connect(kept / FILE)) as copy:
            live.backup(copy)
        shutil.copytree(data_dir / "uploads", kept / "uploads")
        yield Fed(app, client, schema, known, kept)


@pytest.mark.parametrize(("method", "path"), REQUESTS, ids=[f"{method} {path}" for method, path in REQUESTS])
def test_no_request_breaks_the_studio_or_its_promises(fed: Fed, method: str, path: str) -> None:
    operation = fed.schema[path][method.upper()]
    for mode, examples in EXAMPLES.items():
        try:
            _feed(fed, operation, mode, examples)
        except Unsatisfiable:  # an address of which nothing can be wrong
            assert mode is GenerationMode.NEGATIVE
        if method != "get":
            fed.mend()


def _feed(fed: Fed, operation: Any, mode: GenerationMode, examples: int) -> None:
    turn = 0

    @settings(
        max_examples=examples,
        deadline=None,
        database=None,
        derandomize=True,
        phases=[Phase.generate],
        suppress_health_check=list(HealthCheck),
    )
    @given(case=operation.as_strategy(generation_mode=mode))
    def feed(case: schemathesis.Case) -> None:
        nonlocal turn
        turn += 1
        if mode is GenerationMode.POSITIVE and turn % 4:  # three of four requests are about things that are there
            fed.fill_in(case)
        answer = case.call(base_url=BASE_URL, timeout=60)  # s: a busy machine starts a viewer slowly
        case.validate_response(answer, checks=CHECKS.get_all())

    feed()
