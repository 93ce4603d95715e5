"""Logging in and out, and passwords."""

from __future__ import annotations

import logging
import uuid
from dataclasses import dataclass
from datetime import datetime, timedelta

from sqlalchemy import delete, func, select
from sqlalchemy.orm import Session

from server.access.audit import record_act
from server.access.login_throttle import LoginThrottle
from server.access.models import Account, LoginRow, PasswordCodeRow
from server.access.passwords import check_new_password, hash_password, verify_password
from server.access.secrets import hash_secret, make_secret
from server.database import Database, utc_now
from server.errors import ForbiddenError, LoginNeededError

log = logging.getLogger(__name__)

CODE_LIFE = timedelta(days=3)
BY_CODE = "\x00one-time code"
"""In place of a name; none is like it."""

MAX_LOGINS = 50
"""Of one account; the one that was not used for longest goes."""


@dataclass(frozen=True)
class Browser:
    """Where a login comes from."""

    address: str
    user_agent: str
    life: timedelta


def log_in(
    database: Database, throttle: LoginThrottle, name: str, password: str, browser: Browser
) -> tuple[uuid.UUID, str]:
    """The account, and the secret of its new login. No transaction is open while the password is looked at."""
    throttle.begin(name, browser.address)
    with database.reading() as session:
        account = session.scalar(select(Account).where(Account.name == name, Account.disabled_at.is_(None)))
    known = None if account is None else account.password_hash
    is_right, stronger = verify_password(password, known)
    if account is None or not is_right:
        log.warning("failed login of %.80r from %s", name, browser.address)
        raise LoginNeededError("The name or the password is wrong.")
    throttle.forget(name, browser.address)
    with database.writing() as session:
        row = session.get_one(Account, account.id, with_for_update=True)
        if row.password_hash != known or row.disabled_at is not None:
            raise LoginNeededError("The account was changed just now. Log in again.")
        if stronger is not None:
            row.password_hash = stronger
        return row.id, add_login(session, row.id, browser)


def add_login(session: Session, account_id: uuid.UUID, browser: Browser) -> str:
    """A new login; always a new secret, so that nobody can give one to somebody beforehand."""
    now = utc_now()
    session.execute(delete(LoginRow).where(LoginRow.expires_at <= now))
    others = select(LoginRow.id).where(LoginRow.account_id == account_id).order_by(LoginRow.last_seen_at.desc())
    session.execute(delete(LoginRow).where(LoginRow.id.in_(session.scalars(others.offset(MAX_LOGINS - 1)).all())))
    secret = make_secret("login")
    row = LoginRow(
        account_id=account_id,
        secret_hash=hash_secret("login", secret),
        user_agent=browser.user_agent.replace("\0", "")[:300],
        expires_at=now + browser.life,
    )
    session.add(row)
    session.flush()
    record_act(session, account_id, "account.login", "account", account_id, address=browser.address)
    return secret


def end_logins(session: Session, account_id: uuid.UUID, *, but: uuid.UUID | None = None) -> None:
    """End all logins of an account, or all but one."""
    query = delete(LoginRow).where(LoginRow.account_id == account_id)
    session.execute(query if but is None else query.where(LoginRow.id != but))


def change_password(
    database: Database,
    throttle: LoginThrottle,
    account_id: uuid.UUID,
    current: str,
    new: str,
    login_id: uuid.UUID | None,
) -> None:
    """Change one's own password; other browsers must log in again."""
    with database.reading() as session:
        account = session.get_one(Account, account_id)
    check_new_password(new, account.name)
    if account.password_hash is not None:
        throttle.begin(account.name, "own page")
        if not verify_password(current, account.password_hash)[0]:
            raise ForbiddenError("The current password is wrong; nothing was changed.")
        throttle.forget(account.name, "own page")
    password_hash = hash_password(new)
    with database.writing() as session:
        _set_password(session, account_id, password_hash, but=login_id)
        record_act(session, account_id, "account.password", "account", account_id)


def _set_password(session: Session, account_id: uuid.UUID, password_hash: str, *, but: uuid.UUID | None) -> Account:
    row = session.get_one(Account, account_id, with_for_update=True)
    row.password_hash = password_hash
    row.revision += 1
    end_logins(session, account_id, but=but)
    session.execute(delete(PasswordCodeRow).where(PasswordCodeRow.account_id == account_id))
    session.flush()
    return row


def set_password(database: Database, account_id: uuid.UUID, name: str, password: str) -> None:
    """As the command line does it: for whoever may read the data folder anyway."""
    check_new_password(password, name)
    password_hash = hash_password(password)
    with database.writing() as session:
        _set_password(session, account_id, password_hash, but=None)
        record_act(session, None, "account.password", "account", account_id, by="command line")


def make_code(session: Session, account_id: uuid.UUID) -> tuple[str, datetime]:
    """A one-time code for an account, in place of an earlier one, and when it expires."""
    session.execute(delete(PasswordCodeRow).where(PasswordCodeRow.account_id == account_id))
    secret = make_secret("code")
    row = PasswordCodeRow(
        account_id=account_id, secret_hash=hash_secret("code", secret), expires_at=utc_now() + CODE_LIFE
    )
    session.add(row)
    session.flush()
    return secret, row.expires_at


def redeem_code(
    database: Database, throttle: LoginThrottle, code: str, password: str, browser: Browser
) -> tuple[uuid.UUID, str]:
    """Set a password with a one-time code, and log in."""
    throttle.begin(BY_CODE, browser.address)
    query = (
        select(Account)
        .join(PasswordCodeRow, PasswordCodeRow.account_id == Account.id)
        .where(
            PasswordCodeRow.secret_hash == hash_secret("code", code),
            PasswordCodeRow.expires_at > utc_now(),
            Account.disabled_at.is_(None),
        )
    )
    with database.reading() as session:
        account = session.scalar(query)
    if account is None:
        raise LoginNeededError("The code is unknown, used or too old. Ask a lead for a new one.")
    throttle.forget(BY_CODE, browser.address)
    check_new_password(password, account.name)
    password_hash = hash_password(password)
    with database.writing() as session:
        session.get_one(Account, account.id, with_for_update=True)
        if session.scalar(query) is None:  # somebody else was first with it
            raise LoginNeededError("The code was used just now. Ask a lead for a new one.")
        row = _set_password(session, account.id, password_hash, but=None)
        record_act(session, row.id, "account.password", "account", row.id, by="one-time code")
        return row.id, add_login(session, row.id, browser)


def count_admins_who_can_log_in(session: Session) -> int:
    """Admins with a password who are not disabled: without one nobody could manage accounts."""
    query = select(func.count()).select_from(Account)
    return session.scalar(
        query.where(Account.role == "admin", Account.password_hash.is_not(None), Account.disabled_at.is_(None))
    )  # type: ignore[return-value]
