"""What may be asked of an address."""

from __future__ import annotations

import pytest
from fastapi.testclient import TestClient

from server.settings import Settings
from tests.server.api_document import read_document

ID = "00000000-0000-4000-8000-000000000009"


@pytest.fixture
def settings(sqlite_settings: Settings) -> Settings:
    """One database will do: nothing here depends on it."""
    return sqlite_settings


def test_every_address_names_all_its_methods_and_refuses_the_others(client: TestClient) -> None:
    for path, item in read_document()["paths"].items():
        offered = {method.upper() for method in item}
        for method in {"GET", "PUT", "POST", "PATCH", "DELETE", "OPTIONS", "HEAD"} - offered:
            answer = client.request(method, path.replace("{", "").replace("}", ""))
            assert answer.status_code == 405, (method, path)
            assert set(answer.headers["allow"].split(", ")) == offered, (method, path)


@pytest.mark.parametrize("path", ["jobs/batch", "jobs/train", "jobs/bulk"])
def test_an_address_in_words_is_no_id(client: TestClient, path: str) -> None:
    answer = client.get(f"/api/v1/{path}")
    assert (answer.status_code, answer.json()["error"]) == (405, "MethodNotAllowedError")
    assert client.get(f"/api/v1/jobs/{ID}").status_code == 404


@pytest.mark.parametrize("kind", ["application/json", "multipart/form-data; boundary=x", "text/plain"])
@pytest.mark.parametrize("body", [b"\xff\xfe\x00", b"{", b"[" * 100_000, b"", b"null", b'"\\ud800"'])
def test_a_body_that_cannot_be_read_is_answered_as_the_document_says(
    client: TestClient, kind: str, body: bytes
) -> None:
    for path in ("/projects", "/login", "/jobs", "/scans", "/imports"):
        answer = client.post(f"/api/v1{path}", content=body, headers={"Content-Type": kind})
        assert answer.status_code in (415, 422), (path, answer.text)
        assert set(answer.json()) == {"error", "detail"}
