"""The app as a whole: health, the one body of errors, its OpenAPI document."""

from __future__ import annotations

import logging
from pathlib import Path
from typing import Any

import pytest
from fastapi import APIRouter
from fastapi.testclient import TestClient

from server.app import create_app
from server.app.openapi import write_document
from server.settings import Settings
from tests.server.api_document import COMMITTED, read_document
from tests.server.conftest import BASE_URL, Studio


def test_the_studio_says_that_it_works(client: TestClient, studio: Studio) -> None:
    answer = client.get("/api/v1/health")
    assert answer.json() == {"status": "ok", "database": "sqlite" if studio.database.is_sqlite else "postgresql"}
    assert client.get("/api/v1/account").json()["name"] == "local"
    skeleton = client.get("/api/v1/hand-skeleton").json()
    assert (len(skeleton["joints"]), len(skeleton["edges"])) == (21, 20)
    assert skeleton["fingers"] == ["thumb", "index", "middle", "ring", "little"]


@pytest.mark.parametrize(
    ("method", "path", "status"),
    [
        ("GET", "/api/v1/nothing", 404),
        ("GET", "/api", 404),
        ("POST", "/api/v1/health", 405),
        ("POST", "/recordings", 405),
        ("GET", "/api/v1/sequences/not-a-uuid", 422),
        ("GET", "/api/v1/sequences?limit=0", 422),
        ("GET", "/api/v1/sequences/00000000-0000-4000-8000-000000000009", 404),
        ("PATCH", "/api/v1/sequences/00000000-0000-4000-8000-000000000009", 422),
    ],
)
def test_every_failure_has_the_one_body(client: TestClient, method: str, path: str, status: int) -> None:
    answer = client.request(method, path)
    assert answer.status_code == status
    assert set(answer.json()) == {"error", "detail"}
    assert all(isinstance(value, str) and value for value in answer.json().values())


def test_a_body_that_is_not_json_is_told_so(client: TestClient) -> None:
    url = "/api/v1/imports/00000000-0000-4000-8000-000000000009/check"
    for body in ("{", '{"options": NaN}', "[" * 100_000, b"\xff\xfe"):
        answer = client.post(url, content=body, headers={"Content-Type": "application/json"})
        assert answer.status_code in (400, 422)
        assert set(answer.json()) == {"error", "detail"}


def test_a_failure_of_ours_tells_no_insides(settings: Settings, caplog: pytest.LogCaptureFixture) -> None:
    app, router = create_app(settings), APIRouter()

    @router.get("/api/v1/broken")
    def broken() -> None:
        raise RuntimeError("the password is 1234")

    app.router.routes[:0] = router.routes
    with TestClient(app, base_url=BASE_URL) as client, caplog.at_level(logging.ERROR):
        answer = client.get("/api/v1/broken")
    assert answer.status_code == 500
    assert answer.json()["error"] == "InternalError"
    assert "1234" not in answer.text
    assert "Traceback" not in answer.text
    assert answer.headers["x-content-type-options"] == "nosniff"
    assert "1234" in caplog.text


def test_a_database_that_is_busy_for_long_is_no_fault_of_the_request(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("server.database.database.BUSY_TIMEOUT", 0.1)
    app = create_app(Settings(data_dir=tmp_path))
    with TestClient(app, base_url=BASE_URL) as client, app.state.database.writing():
        answer = client.post("/api/v1/sequences/00000000-0000-4000-8000-000000000009/restore")
        assert (answer.status_code, answer.json()["error"]) == (503, "DatabaseUnavailableError")
        assert client.get("/api/v1/sequences").status_code == 200


def operations() -> list[tuple[str, str, dict[str, Any]]]:
    return [
        (method, path, operation)
        for path, item in read_document()["paths"].items()
        for method, operation in item.items()
    ]


def test_the_document_is_the_same_each_time_and_as_it_is_committed() -> None:
    document = write_document()
    assert write_document() == document
    assert COMMITTED.read_text() == document, "run `make api` and commit what it writes"


def test_every_operation_has_a_name_of_its_own_that_reads_well() -> None:
    names = [operation["operationId"] for _, _, operation in operations()]
    assert len(set(names)) == len(names)
    assert all(name.replace("_", "").isalnum() and name.islower() for name in names)


def test_every_operation_says_what_it_answers_and_how_it_fails() -> None:
    for method, path, operation in operations():
        responses = operation["responses"]
        assert operation.get("description") or operation.get("summary")
        for status, response in responses.items():
            content = response.get("content", {})
            if int(status) >= 400:
                schema = content["application/json"]["schema"]["$ref"]
                assert schema.endswith(("/ErrorBody", "Conflict")), (method, path, status)
            elif int(status) not in (204, 304):
                assert content, (method, path, status)
                json_type = content.get("application/json", {})
                # A file may come as one of several types; the JSON that FastAPI adds by itself is not one of them.
                assert len(content) == 1 or "schema" not in json_type, (method, path, status)
                assert len(content) > 1 or json_type.get("schema", True), (method, path, status)
        assert {"403", "422", "500"} <= responses.keys(), (method, path)
