"""Who comes in: by a cookie or a token that is known, not too old and of an account that is not disabled."""

from __future__ import annotations

import logging
import uuid
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from sqlalchemy import text
from starlette.datastructures import Headers

from server.access.authentication import MAX_SECRET, SEEN_EVERY, find_user, name_cookie, note_seen, read_cookie
from server.access.current_user import CurrentUser
from server.access.models import Account, LoginRow, TokenRow
from server.access.secrets import hash_secret
from server.database import Database, utc_now
from server.errors import LoginNeededError
from server.settings import Settings
from tests.server.rows import keep, make_person

HOUR = timedelta(hours=1)
SETTINGS = Settings(port=8123, login_days=14)


@pytest.fixture
def database_kind() -> str:
    return "sqlite"


@dataclass
class Door:
    """A studio's door, and Ann, who has a login and a token."""

    database: Database
    ann: Account

    def login(self, secret: str, **columns: Any) -> uuid.UUID:
        facts = {"id": uuid.uuid4(), "account_id": self.ann.id, "expires_at": utc_now() + HOUR}
        row = LoginRow(secret_hash=hash_secret("login", secret), **(facts | columns))
        keep(self.database, row)
        return row.id

    def token(self, secret: str, **columns: Any) -> uuid.UUID:
        facts = {"id": uuid.uuid4(), "account_id": self.ann.id, "name": "script"}
        row = TokenRow(secret_hash=hash_secret("token", secret), **(facts | columns))
        keep(self.database, row)
        return row.id

    def enter(self, cookie: str = "", *authorizations: str) -> tuple[CurrentUser, bool]:
        lines = [(b"authorization", one.encode()) for one in authorizations]
        if cookie:
            lines.append((b"cookie", f"{name_cookie(SETTINGS)}={cookie}".encode()))
        return find_user(self.database, Headers(raw=lines), SETTINGS)


@pytest.fixture
def door(database: Database) -> Door:
    ann = make_person("Ann", "reviewer")
    keep(database, ann)
    return Door(database, ann)


def cookies(*lines: str) -> Headers:
    return Headers(raw=[(b"cookie", line.encode()) for line in lines])


@pytest.mark.parametrize(
    ("lines", "secret"),
    [
        (["a=1; handloom_login_8123=s3; b=2"], "s3"),
        (["a=1", "handloom_login_8123=s3"], "s3"),
        (["handloom_login_8123=first; handloom_login_8123=second"], "first"),
        (["handloom_login_8123=; handloom_login_8123=second"], "second"),
        (["handloom_login_8123=a=b"], "a=b"),
        (["handloom_login_8000=s3"], None),
        (["xhandloom_login_8123=s3"], None),
        ([f"handloom_login_8123={'x' * MAX_SECRET}"], "x" * MAX_SECRET),
        ([f"handloom_login_8123={'x' * (MAX_SECRET + 1)}"], None),
        ([], None),
    ],
)
def test_the_secret_is_that_of_this_studio_among_all_cookies(lines: list[str], secret: str | None) -> None:
    assert (read_cookie(cookies(*lines), SETTINGS) or None) == secret


@given(st.binary(max_size=30), st.binary(max_size=30))
def test_no_cookie_breaks_the_reading(before: bytes, after: bytes) -> None:
    line = before + b"handloom_login_8123=" + after
    found = read_cookie(Headers(raw=[(b"cookie", line)]), SETTINGS)
    assert found is None or found.encode("latin-1") in line


def test_a_login_and_a_token_say_who_it_is_and_what_they_may(door: Door) -> None:
    login_id, reading, writing = door.login("c"), door.token("r"), door.token("w", may_write=True)
    who = {"account_id": door.ann.id, "name": "Ann", "role": "reviewer"}
    assert door.enter("c")[0] == CurrentUser(**who, login_id=login_id)
    assert door.enter("", "Bearer r")[0] == CurrentUser(**who, may_write=False, token_id=reading)
    assert door.enter("", "bearer  w ")[0] == CurrentUser(**who, may_write=True, token_id=writing)
    assert door.enter("c", "Bearer r")[0].token_id == reading, "a token wins over a cookie"


@pytest.mark.parametrize("secret", ["r", "unknown", "c" * 201])
def test_a_cookie_that_is_none_is_nobody(door: Door, secret: str) -> None:
    door.token("r")
    with pytest.raises(LoginNeededError, match="You are not logged in, or no longer"):
        door.enter(secret)


def test_what_has_ended_opens_nothing(door: Door) -> None:
    past = utc_now() - timedelta(seconds=1)
    door.login("old", expires_at=past)
    door.token("old", expires_at=past)
    door.token("revoked", revoked_at=past)
    door.token("lasting", expires_at=utc_now() + HOUR)
    assert door.enter("", "Bearer lasting")[0].name == "Ann"
    with pytest.raises(LoginNeededError, match="You are not logged in"):
        door.enter("old")
    for secret in ("old", "revoked", "unknown"):
        with pytest.raises(LoginNeededError, match=r"The token is unknown, expired or revoked. Make a new one"):
            door.enter("", f"Bearer {secret}")


def test_a_disabled_account_is_shut_out_with_all_it_has(door: Door) -> None:
    door.login("c")
    door.token("t")
    with door.database.writing() as session:
        session.get_one(Account, door.ann.id).disabled_at = utc_now()
    for ways in (("c",), ("", "Bearer t")):
        with pytest.raises(LoginNeededError):
            door.enter(*ways)


@pytest.mark.parametrize(
    "authorizations", [("Bearer t", "Bearer t"), ("Basic t",), ("Bearer",), ("Bearer " + "t" * 201,)]
)
def test_an_authorization_that_cannot_be_read_is_refused_though_a_cookie_would_do(
    door: Door, authorizations: tuple[str, ...]
) -> None:
    door.login("c")
    door.token("t")
    with pytest.raises(LoginNeededError, match="cannot be read; needed `Authorization: Bearer <token>`"):
        door.enter("c", *authorizations)


def test_it_is_noted_once_a_minute_that_somebody_was_seen_and_a_login_lives_on(door: Door) -> None:
    login_id = door.login("c", last_seen_at=utc_now() - SEEN_EVERY - timedelta(seconds=1))
    token_id = door.token("t")
    for ways in (("c",), ("", "Bearer t")):
        user, is_to_note = door.enter(*ways)
        assert is_to_note
        note_seen(door.database, user, SETTINGS)
        assert door.enter(*ways) == (user, False)

    def is_now(moment: datetime | None, later: timedelta = timedelta(0)) -> bool:
        return moment is not None and abs(moment - later - utc_now()) < timedelta(minutes=1)

    with door.database.reading() as session:
        login, token = session.get_one(LoginRow, login_id), session.get_one(TokenRow, token_id)
    assert is_now(login.last_seen_at) and is_now(login.expires_at, timedelta(days=14))
    assert is_now(token.last_used_at) and token.expires_at is None


def test_a_note_that_cannot_be_made_hinders_nobody(door: Door, caplog: pytest.LogCaptureFixture) -> None:
    door.login("c")
    user, _ = door.enter("c")
    with door.database.writing() as session:
        session.execute(text("ALTER TABLE logins RENAME TO gone"))
    with caplog.at_level(logging.WARNING):
        note_seen(door.database, user, SETTINGS)
    assert f"not noted that {door.ann.id} was seen" in caplog.text
