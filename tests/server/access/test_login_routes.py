"""Addresses of logging in and out; what stands behind them is tried in `test_login.py`."""

from __future__ import annotations

import uuid
from datetime import timedelta

import pytest
from fastapi.testclient import TestClient
from sqlalchemy import select

from server.access.authentication import name_cookie
from server.access.login_routes import COOKIE_LIFE
from server.access.models import LoginRow
from tests.server.access.conftest import PASSWORD, Lab

API = "/api/v1"


@pytest.fixture
def database_kind() -> str:
    return "sqlite"


def log_in(client: TestClient, **headers: str):
    return client.post(f"{API}/login", json={"name": "Ann", "password": PASSWORD}, headers=headers)


def test_the_cookie_lives_as_long_as_browsers_allow_and_is_taken_back_on_logging_out(lab: Lab) -> None:
    lab.add("Ann")
    given = log_in(lab.nobody).headers["set-cookie"]
    assert given.startswith(f"{name_cookie(lab.settings)}=") and f"Max-Age={int(COOKIE_LIFE.total_seconds())};" in given
    assert timedelta(days=lab.settings.login_days) < COOKIE_LIFE
    taken = lab.nobody.post(f"{API}/logout").headers["set-cookie"]
    assert taken.startswith(f'{name_cookie(lab.settings)}="";') and "Max-Age=0;" in taken


def test_browsers_are_listed_the_last_used_first_and_this_one_marked(lab: Lab) -> None:
    ann = lab.add("Ann")
    clients = [lab.browser(ann) for _ in range(3)]
    with lab.database.writing() as session:
        rows = session.scalars(select(LoginRow)).all()
        for number, row in enumerate(rows):
            row.last_seen_at -= timedelta(seconds=number)
        rows[2].user_agent = "Firefox"
        order = [str(row.id) for row in rows]
    told = [client.get(f"{API}/account/logins").json() for client in clients]
    for page in told:
        assert [item["id"] for item in page["items"]] == order and page["next_cursor"] is None
        assert [item["user_agent"] for item in page["items"]] == ["test", "test", "Firefox"]
    own = [[item["id"] for item in page["items"] if item["is_this"]] for page in told]
    assert sorted(id_ for [id_] in own) == sorted(order)


def test_a_login_that_is_nobodys_or_somebody_elses_is_not_ended(lab: Lab) -> None:
    ann, bob = lab.person("annotator", "Ann"), lab.person("annotator", "Bob")
    [theirs] = bob.get(f"{API}/account/logins").json()["items"]
    for id_ in (uuid.uuid4(), theirs["id"]):
        answer = ann.delete(f"{API}/account/logins/{id_}")
        assert answer.status_code == 404 and answer.json()["detail"] == "You are not logged in there, or no longer."
    assert bob.get(f"{API}/account").status_code == 200


def test_logging_in_again_as_somebody_else_ends_the_login_before(lab: Lab) -> None:
    lab.add("Ann")
    browser = lab.person("lead", "Lea")
    answer = log_in(browser)
    assert (answer.json()["name"], browser.get(f"{API}/account").json()["name"]) == ("Ann", "Ann")
    with lab.database.reading() as session:
        assert len(session.scalars(select(LoginRow)).all()) == 1
