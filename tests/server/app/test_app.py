"""The app as a whole: health, errors, guard, the one body."""

from __future__ import annotations

from fastapi.testclient import TestClient


def test_the_studio_says_that_it_works(client: TestClient) -> None:
    answer = client.get("/api/v1/health")
    assert answer.status_code == 200
    assert answer.json()["status"] == "ok"
    assert client.get("/api/v1/account").json()["name"] == "local"
