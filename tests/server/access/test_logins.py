"""Logins, passwords and codes as the rooms above ask for them: what counts, what ends, and when nothing is changed."""

from __future__ import annotations

import uuid
from dataclasses import dataclass
from datetime import timedelta
from typing import Any

import pytest
from sqlalchemy import func, select, update

from server.access import logins
from server.access.login_throttle import LoginThrottle
from server.access.logins import MAX_LOGINS, Browser
from server.access.models import Account, AuditRow, LoginRow, PasswordCodeRow, Role
from server.access.secrets import hash_secret
from server.database import Database, utc_now
from server.errors import ForbiddenError, InvalidError, LoginNeededError
from tests.server.access.conftest import PASSWORD, password_hash
from tests.server.rows import keep, make_person

HERE = Browser("127.0.0.1", "Firefox\0" + "x" * 400, timedelta(days=14))


@pytest.fixture
def database_kind() -> str:
    return "sqlite"


@dataclass
class Desk:
    """Ann, who has a password."""

    database: Database
    throttle: LoginThrottle
    ann: Account

    def log_in(self, name: str = "Ann", password: str = PASSWORD) -> tuple[uuid.UUID, str]:
        return logins.log_in(self.database, self.throttle, name, password, HERE)

    def add_login(self) -> str:
        """As `log_in`, without a password to look at."""
        with self.database.writing() as session:
            return logins.add_login(session, self.ann.id, HERE)

    def hashes(self) -> set[str]:
        with self.database.reading() as session:
            return set(session.scalars(select(LoginRow.secret_hash)))

    def acts(self) -> list[tuple[str, Any]]:
        with self.database.reading() as session:
            return [(row.act, row.detail) for row in session.scalars(select(AuditRow).order_by(AuditRow.time))]

    def account(self) -> Account:
        with self.database.reading() as session:
            return session.get_one(Account, self.ann.id)

    def make_code(self) -> str:
        with self.database.writing() as session:
            return logins.make_code(session, self.ann.id)[0]

    def redeem(self, code: str, password: str = "another four words") -> tuple[uuid.UUID, str]:
        return logins.redeem_code(self.database, self.throttle, code, password, HERE)


@pytest.fixture
def desk(database: Database) -> Desk:
    ann = make_person("Ann")
    ann.password_hash = password_hash()
    keep(database, ann)
    return Desk(database, LoginThrottle(), ann)


def test_a_login_is_kept_by_the_hash_of_its_secret_with_where_it_came_from(desk: Desk) -> None:
    account_id, secret = desk.log_in()
    assert account_id == desk.ann.id and desk.hashes() == {hash_secret("login", secret)}
    with desk.database.reading() as session:
        [row] = session.scalars(select(LoginRow))
    assert row.user_agent == ("Firefox" + "x" * 400)[:300]
    assert abs(row.expires_at - utc_now() - HERE.life) < timedelta(minutes=1)
    assert desk.acts() == [("account.login", {"address": "127.0.0.1"})]


@pytest.mark.parametrize(("name", "password"), [("Ann", "wrong"), ("Bob", PASSWORD), ("ann ", PASSWORD), ("Ann", "")])
def test_a_wrong_name_and_a_wrong_password_are_one_refusal(desk: Desk, name: str, password: str) -> None:
    with pytest.raises(LoginNeededError, match=r"^The name or the password is wrong\.$"):
        desk.log_in(name, password)
    assert desk.hashes() == set()


def test_of_too_many_logins_the_one_not_used_for_longest_goes_and_those_that_ended_too(desk: Desk) -> None:
    with desk.database.writing() as session:
        session.add_all(
            LoginRow(
                account_id=desk.ann.id,
                secret_hash=f"{n}",
                last_seen_at=utc_now() - timedelta(minutes=n),
                expires_at=utc_now() + timedelta(hours=1 if n != 3 else -1),
            )
            for n in range(MAX_LOGINS + 1)
        )
    with desk.database.writing() as session:
        secret = logins.add_login(session, desk.ann.id, HERE)
    kept = {str(n) for n in range(MAX_LOGINS) if n != 3} | {hash_secret("login", secret)}
    assert desk.hashes() == kept and len(kept) == MAX_LOGINS


def test_a_new_password_keeps_the_browser_it_was_changed_in_and_no_code(desk: Desk) -> None:
    here, there, code = desk.add_login(), desk.add_login(), desk.make_code()
    with desk.database.reading() as session:
        here_id = session.scalar(select(LoginRow.id).where(LoginRow.secret_hash == hash_secret("login", here)))
    before = desk.account().revision

    def change(current: str, new: str) -> None:
        logins.change_password(desk.database, desk.throttle, desk.ann.id, current, new, here_id)

    with pytest.raises(ForbiddenError, match="The current password is wrong; nothing was changed"):
        change("wrong", "another four words")
    with pytest.raises(InvalidError):
        change(PASSWORD, "short")
    assert desk.account().revision == before and hash_secret("login", there) in desk.hashes()
    change(PASSWORD, "another four words")
    assert desk.account().revision == before + 1 and desk.hashes() == {hash_secret("login", here)}
    assert desk.acts()[-1] == ("account.password", {})
    with pytest.raises(LoginNeededError, match="The code is unknown"):
        desk.redeem(code)
    with pytest.raises(LoginNeededError, match="is wrong"):
        desk.log_in()
    assert desk.log_in(password="another four words")[0] == desk.ann.id


def test_a_code_counts_once_and_a_newer_one_takes_its_place(desk: Desk) -> None:
    old, code = desk.make_code(), desk.make_code()
    ended = desk.add_login()
    for wrong in (old, "unknown", ended):
        with pytest.raises(LoginNeededError, match=r"The code is unknown, used or too old. Ask a lead for a new one"):
            desk.redeem(wrong)
    with pytest.raises(InvalidError):
        desk.redeem(code, "short")
    account_id, secret = desk.redeem(code)
    assert account_id == desk.ann.id and desk.hashes() == {hash_secret("login", secret)}
    assert ("account.password", {"by": "one-time code"}) in desk.acts()
    with pytest.raises(LoginNeededError, match="The code is unknown"):
        desk.redeem(code)


def test_a_code_that_is_too_old_or_of_a_disabled_account_opens_nothing(desk: Desk) -> None:
    code = desk.make_code()
    for change in (
        update(PasswordCodeRow).values(expires_at=utc_now() - timedelta(seconds=1)),
        update(Account).where(Account.id == desk.ann.id).values(disabled_at=utc_now()),
    ):
        with desk.database.writing() as session:
            session.execute(change)
        with pytest.raises(LoginNeededError, match="The code is unknown, used or too old"):
            desk.redeem(code)
        with desk.database.writing() as session:
            session.execute(update(PasswordCodeRow).values(expires_at=utc_now() + timedelta(hours=1)))


def test_an_admin_can_log_in_with_a_password_while_not_disabled(desk: Desk) -> None:
    def make(name: str, role: Role, **columns: Any) -> Account:
        person = make_person(name, role)
        for column, value in columns.items():
            setattr(person, column, value)
        return person

    keep(
        desk.database,
        make("open", "admin", password_hash="x"),
        make("second", "admin", password_hash="x"),
        make("gone", "admin", password_hash="x", disabled_at=utc_now()),
        make("new", "admin"),
        make("lead", "lead", password_hash="x"),
    )
    with desk.database.reading() as session:
        assert logins.count_admins_who_can_log_in(session) == 2


def test_logins_of_others_are_left_alone(desk: Desk) -> None:
    bob = make_person("Bob")
    keep(desk.database, bob)
    with desk.database.writing() as session:
        for person in (desk.ann, desk.ann, bob):
            logins.add_login(session, person.id, HERE)
        logins.end_logins(session, desk.ann.id)
        left = session.execute(select(LoginRow.account_id, func.count()).group_by(LoginRow.account_id)).all()
    assert [tuple(row) for row in left] == [(bob.id, 1)]
