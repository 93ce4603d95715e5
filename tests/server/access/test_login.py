"""Logging in and out."""

from __future__ import annotations

import logging
import time
from datetime import timedelta
from pathlib import Path

import pytest
from fastapi.testclient import TestClient
from sqlalchemy import func, select, update

from server.access import passwords
from server.access.authentication import name_cookie
from server.access.models import Account, LoginRow
from server.database import utc_now
from server.settings import Settings
from tests.server.access.conftest import PASSWORD, Lab

ME = "/api/v1/account"


def log_in(client: TestClient, name: str = "Anna", password: str = PASSWORD, **headers: str):
    return client.post("/api/v1/login", json={"name": name, "password": password}, headers=headers)


def test_who_logs_in_is_known_until_they_log_out(lab: Lab) -> None:
    lab.add("Anna", "reviewer")
    assert lab.nobody.get(ME).status_code == 401
    answer = log_in(lab.nobody)
    assert (answer.json()["name"], answer.json()["role"]) == ("Anna", "reviewer")
    me = lab.nobody.get(ME).json()
    assert (me["name"], me["is_login_needed"], me["by_token"]) == ("Anna", True, False)
    secret = lab.nobody.cookies[name_cookie(lab.settings)]
    assert lab.nobody.post("/api/v1/logout").status_code == 204
    assert lab.nobody.get(ME).status_code == 401
    lab.give_cookie(lab.nobody, secret)
    assert lab.nobody.get(ME).status_code == 401, "the cookie's secret opens nothing after logging out"


def test_the_cookie_is_kept_from_scripts_and_other_sites_and_the_database_keeps_its_hash_only(lab: Lab) -> None:
    lab.add("Anna")
    plain = log_in(lab.nobody).headers["set-cookie"]
    assert "HttpOnly" in plain and "SameSite=strict" in plain and "Path=/" in plain and "Secure" not in plain
    secure = lab.settings.model_copy(update={"allowed_origins": ("https://127.0.0.1:8000",)})
    assert secure.is_login_needed
    assert "Secure" in log_in(lab.nobody, Origin="https://127.0.0.1:8000").headers["set-cookie"]
    secret = lab.nobody.cookies[name_cookie(lab.settings)]
    with lab.database.reading() as session:
        hashes = session.scalars(select(LoginRow.secret_hash)).all()
    assert secret not in hashes
    assert len(hashes) == 1, "logging in again in the same browser ends the login before"


def test_a_login_given_beforehand_is_not_taken_up(lab: Lab) -> None:
    """Session fixation."""
    lab.add("Anna")
    lab.give_cookie(lab.nobody, "chosen-by-somebody-else")
    log_in(lab.nobody)
    assert "chosen-by-somebody-else" not in lab.nobody.cookies.values()
    thief = lab.browser()
    lab.give_cookie(thief, "chosen-by-somebody-else")
    assert thief.get(ME).status_code == 401


def test_logging_out_everywhere_and_one_by_one(lab: Lab) -> None:
    anna = lab.add("Anna")
    first, second, third, other = (
        lab.browser(anna),
        lab.browser(anna),
        lab.browser(anna),
        lab.person("annotator", "Ben"),
    )
    logins = first.get("/api/v1/account/logins").json()["items"]
    assert [login["is_this"] for login in logins].count(True) == 1
    theirs = other.get("/api/v1/account/logins").json()["items"][0]["id"]
    assert first.delete(f"/api/v1/account/logins/{theirs}").status_code == 404
    not_this = [login["id"] for login in logins if not login["is_this"]]
    assert first.delete(f"/api/v1/account/logins/{not_this[0]}").status_code == 204
    assert sorted(client.get(ME).status_code for client in (first, second, third)) == [200, 200, 401]
    assert first.post("/api/v1/logout/everywhere").status_code == 204
    assert [client.get(ME).status_code for client in (first, second, third)] == [401] * 3
    assert other.get(ME).status_code == 200


def test_a_login_that_is_used_goes_on_and_one_that_is_not_ends(lab: Lab) -> None:
    client = lab.person("annotator")

    def move(**times: timedelta) -> None:
        with lab.database.writing() as session:
            session.execute(update(LoginRow).values({name: utc_now() + time for name, time in times.items()}))

    def expires_at():
        with lab.database.reading() as session:
            return session.scalar(select(LoginRow.expires_at))

    move(last_seen_at=timedelta(seconds=-30), expires_at=timedelta(seconds=60))
    before = expires_at()
    assert client.get(ME).status_code == 200
    time.sleep(0.1)
    assert expires_at() == before, "noted once a minute at most"
    move(last_seen_at=timedelta(minutes=-2), expires_at=timedelta(seconds=60))
    assert client.get(ME).status_code == 200
    ends = time.monotonic() + 10
    while expires_at() < utc_now() + timedelta(days=13) and time.monotonic() < ends:
        time.sleep(0.02)
    assert expires_at() > utc_now() + timedelta(days=13)
    move(expires_at=timedelta(seconds=-1))
    assert client.get(ME).status_code == 401


def test_a_disabled_account_is_shut_at_once(lab: Lab) -> None:
    anna = lab.add("Anna")
    client = lab.browser(anna)
    with lab.database.writing() as session:
        session.execute(update(Account).where(Account.id == anna).values(disabled_at=utc_now()))
    assert client.get(ME).status_code == 401
    assert log_in(lab.nobody).status_code == 401


def test_nobody_learns_who_has_an_account(lab: Lab, monkeypatch: pytest.MonkeyPatch) -> None:
    """Wrong passwords and unknown names: one answer, and the same work of argon2 behind it."""
    lab.add("Anna")
    looked_at: list[bool] = []
    real = passwords._hash

    class Counting:
        def verify(self, *arguments: object) -> bool:
            looked_at.append(True)
            return real.verify(*arguments)  # type: ignore[arg-type]

        def verify_and_update(self, *arguments: object):
            looked_at.append(True)
            return real.verify_and_update(*arguments)  # type: ignore[arg-type]

        def hash(self, *arguments: object) -> str:
            return real.hash(*arguments)  # type: ignore[arg-type]

    monkeypatch.setattr(passwords, "_hash", Counting())
    known, unknown, local = (log_in(lab.nobody, name, "not her password") for name in ("Anna", "Zoe", "local"))
    assert known.status_code == unknown.status_code == local.status_code == 401
    assert known.json() == unknown.json() == local.json()
    assert len(looked_at) == 3


def test_who_guesses_waits_and_others_do_not(lab: Lab) -> None:
    lab.add("Anna")
    lab.add("Ben")
    answers = [log_in(lab.nobody, "Anna", f"guess number {n}") for n in range(6)]
    assert [answer.status_code for answer in answers] == [401] * 5 + [429]
    assert 0 < int(answers[-1].headers["retry-after"]) <= 301
    assert log_in(lab.nobody, "anna").status_code == 429, "another spelling is the same name"
    assert log_in(lab.nobody).status_code == 429, "the right password helps no more"
    assert log_in(lab.nobody, "Ben").status_code == 200


def test_failed_logins_leave_one_line_in_the_log_whatever_the_name(lab: Lab, caplog: pytest.LogCaptureFixture) -> None:
    """Log injection; and a password never gets into the log."""
    with caplog.at_level(logging.DEBUG):
        log_in(lab.nobody, "Anna\n2026-01-01 INFO server: all is well \x1b[31m", "secret-of-somebody")
        log_in(lab.nobody, "Anna\u2028\u202e", "secret-of-somebody")
    lines = [record.getMessage() for record in caplog.records if "failed login" in record.getMessage()]
    assert len(lines) == 2
    assert not any(character in line for line in lines for character in "\n\r\x1b\u2028\u202e")
    assert "secret-of-somebody" not in caplog.text
    assert log_in(lab.nobody, "A\0nna").status_code == 422


@pytest.mark.parametrize("password", ["short", "aaaaaaaaaaaa", "annaannaanna", "password1234567890", "x" * 201])
def test_a_password_that_is_soon_guessed_is_refused(lab: Lab, password: str) -> None:
    client = lab.person("annotator", "Anna")
    answer = client.put(f"{ME}/password", json={"current": PASSWORD, "new": password})
    assert answer.status_code == 422
    assert password not in answer.text


def test_a_new_password_ends_the_other_logins(lab: Lab) -> None:
    anna = lab.add("Anna")
    here, there = lab.browser(anna), lab.browser(anna)
    wrong = here.put(f"{ME}/password", json={"current": "not the one", "new": "another four words"})
    assert wrong.status_code == 403
    right = here.put(f"{ME}/password", json={"current": PASSWORD, "new": "another four words"})
    assert right.status_code == 204
    assert (here.get(ME).status_code, there.get(ME).status_code) == (200, 401)
    assert log_in(there, password=PASSWORD).status_code == 401
    assert log_in(there, password="another four words").status_code == 200


def test_a_code_sets_a_password_once(lab: Lab) -> None:
    admin = lab.person("admin")
    made = admin.post("/api/v1/accounts", json={"name": "Anna"}).json()
    assert not made["person"]["has_password"]
    code = {"code": made["code"]["code"], "password": "another four words"}
    assert lab.nobody.post("/api/v1/login/code", json=code | {"password": "short"}).status_code == 422
    welcome = lab.nobody.post("/api/v1/login/code", json=code)
    assert welcome.json()["name"] == "Anna"
    assert lab.nobody.get(ME).json()["name"] == "Anna"
    assert lab.browser().post("/api/v1/login/code", json=code).status_code == 401
    # a code is neither a token nor a cookie
    second = admin.post(f"/api/v1/accounts/{made['person']['id']}/code").json()["code"]
    assert lab.browser().get(ME, headers={"Authorization": f"Bearer {second}"}).status_code == 401
    thief = lab.browser()
    lab.give_cookie(thief, second)
    assert thief.get(ME).status_code == 401
    third = admin.post(f"/api/v1/accounts/{made['person']['id']}/code").json()["code"]
    assert lab.browser().post("/api/v1/login/code", json=code | {"code": second}).status_code == 401
    assert lab.browser().post("/api/v1/login/code", json=code | {"code": third}).status_code == 200


def test_an_account_keeps_a_bounded_number_of_logins(lab: Lab) -> None:
    anna = lab.add("Anna")
    for _ in range(53):
        lab.browser(anna)
    with lab.database.reading() as session:
        assert session.scalar(select(func.count()).select_from(LoginRow)) == 50


def test_when_people_must_log_in(tmp_path: Path) -> None:
    def needs(**more: object) -> bool:
        return Settings(data_dir=tmp_path, **more).is_login_needed  # type: ignore[arg-type]

    assert not needs()
    assert not needs(host="localhost")
    assert needs(login="required")
    assert needs(host="0.0.0.0")
    assert needs(host="192.168.1.5")
    assert needs(allowed_hosts=("studio.lab",)), "a proxy brings others to the loopback"
