"""What the browser app remembers for a person."""

from __future__ import annotations

from typing import Any

import pytest
from fastapi.testclient import TestClient

PREFERENCES = "/api/v1/account/preferences"


def test_preferences_are_kept_as_they_were_given(client: TestClient) -> None:
    document = {"keys": {"annotate.next": ["N", "ArrowRight"]}, "größe": 1.5, "none": None}
    answer = client.put(PREFERENCES, json=document)
    assert answer.json()["preferences"] == document
    again = client.get("/api/v1/account")
    assert again.json() == answer.json()
    assert again.headers["etag"] == answer.headers["etag"]


def test_of_two_tabs_the_one_that_asks_is_told_of_the_other(client: TestClient) -> None:
    etag = client.get("/api/v1/account").headers["etag"]
    assert client.put(PREFERENCES, json={"a": 1}, headers={"If-Match": etag}).status_code == 200
    late = client.put(PREFERENCES, json={"a": 2}, headers={"If-Match": etag})
    assert (late.status_code, late.json()["theirs"]) == (409, {"a": 1})
    assert client.put(PREFERENCES, json={"a": 4}, headers={"If-Match": ""}).status_code == 422, "it asks for nothing"
    assert client.put(PREFERENCES, json={"a": 3}).json()["preferences"] == {"a": 3}


@pytest.mark.parametrize(
    ("body", "status"),
    [
        ('{"a": "' + "x" * 64_000 + '"}', 413),
        ('{"a": NaN}', 422),
        ('{"a": 1e999}', 422),
        ('{"a": "\\u0000"}', 422),
        ('{"a": "\\ud800"}', 422),
        ("[1]", 422),
        ('{"a": ' + "[" * 100_000, 422),
    ],
)
def test_what_cannot_be_kept_is_refused_and_nothing_changes(client: TestClient, body: str, status: int) -> None:
    before: dict[str, Any] = client.get("/api/v1/account").json()
    answer = client.put(PREFERENCES, content=body, headers={"Content-Type": "application/json"})
    assert answer.status_code in (status, 400 if status == 422 else status), answer.text
    assert client.get("/api/v1/account").json() == before
