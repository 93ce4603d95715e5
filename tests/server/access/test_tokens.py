"""Tokens: the way in for scripts."""

from __future__ import annotations

from datetime import timedelta

import pytest
from fastapi.testclient import TestClient
from sqlalchemy import select, update

from server.access.models import TokenRow
from server.database import utc_now
from tests.server.access.conftest import Lab

TOKENS = "/api/v1/account/tokens"
NONE = "00000000-0000-4000-8000-000000000009"


def bearer(secret: str) -> dict[str, str]:
    return {"Authorization": f"Bearer {secret}"}


def make(client: TestClient, **more: object) -> dict:
    answer = client.post(TOKENS, json={"name": "a script", **more})
    assert answer.status_code == 201
    return answer.json()


def test_a_token_is_shown_once_and_kept_as_a_hash(lab: Lab) -> None:
    anna = lab.person("lead", "Anna")
    made = make(anna)
    listed = anna.get(TOKENS).json()["items"]
    assert [item["name"] for item in listed] == ["a script"]
    assert "secret" not in listed[0]
    with lab.database.reading() as session:
        assert made["secret"] not in session.scalars(select(TokenRow.secret_hash)).all()
    me = lab.nobody.get("/api/v1/account", headers=bearer(made["secret"])).json()
    assert (me["name"], me["by_token"], me["may_write"]) == ("Anna", True, False)


def test_a_token_that_may_only_read_changes_nothing(lab: Lab) -> None:
    lead = lab.person("lead")
    reading, writing = make(lead)["secret"], make(lead, may_write=True)["secret"]
    url = f"/api/v1/sequences/{NONE}/restore"
    assert lab.nobody.get("/api/v1/sequences", headers=bearer(reading)).status_code == 200
    assert lab.nobody.post(url, headers=bearer(reading)).status_code == 403
    assert lab.nobody.post(url, headers=bearer(writing)).status_code == 404
    assert lead.post(url, headers=bearer(reading)).status_code == 403, "a cookie beside it gives no more"


def test_a_token_may_no_more_than_its_person(lab: Lab) -> None:
    token = make(lab.person("annotator"), may_write=True)["secret"]
    assert lab.nobody.delete(f"/api/v1/tracks/{NONE}", headers=bearer(token)).status_code == 403


@pytest.mark.parametrize(
    ("method", "path"),
    [
        ("GET", "/account/tokens"),
        ("POST", "/account/tokens"),
        ("DELETE", f"/account/tokens/{NONE}"),
        ("GET", "/account/logins"),
        ("DELETE", f"/account/logins/{NONE}"),
        ("PUT", "/account/password"),
        ("POST", "/logout"),
        ("POST", "/logout/everywhere"),
        ("GET", "/accounts"),
        ("POST", "/accounts"),
        ("PATCH", f"/accounts/{NONE}"),
        ("POST", f"/accounts/{NONE}/code"),
        ("GET", "/audit"),
    ],
)
def test_a_stolen_token_opens_no_account_administration(lab: Lab, method: str, path: str) -> None:
    token = make(lab.person("admin"), may_write=True)["secret"]
    bodies = {"POST": {"name": "x"}, "PUT": {"new": "four other words"}, "PATCH": {}}
    answer = lab.nobody.request(method, f"/api/v1{path}", json=bodies.get(method), headers=bearer(token))
    assert (answer.status_code, "token" in answer.json()["detail"]) == (403, True)


def test_a_token_ends_when_revoked_or_too_old(lab: Lab) -> None:
    anna = lab.person("annotator", "Anna")
    revoked, old = make(anna), make(anna, days=1)
    ben = lab.person("annotator", "Ben")
    assert ben.delete(f"{TOKENS}/{revoked['id']}").status_code == 404
    assert anna.delete(f"{TOKENS}/{revoked['id']}").status_code == 204
    with lab.database.writing() as session:
        past = utc_now() - timedelta(seconds=1)
        session.execute(update(TokenRow).where(TokenRow.name == "a script").values(expires_at=past))
    for made in (revoked, old):
        assert lab.nobody.get("/api/v1/account", headers=bearer(made["secret"])).status_code == 401


@pytest.mark.parametrize("value", ["", "Bearer", "Bearer ", "Basic YTpi", "Bearer " + "x" * 5000, "bearer \xff"])
def test_an_authorization_that_is_none_is_refused_even_beside_a_cookie(lab: Lab, value: str) -> None:
    client = lab.person("admin")
    answer = client.get("/api/v1/account", headers=[(b"authorization", value.encode("latin-1"))])
    assert answer.status_code == 401
    assert set(answer.json()) == {"error", "detail"}
