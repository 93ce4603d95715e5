"""Who comes in with a cookie or a token: one short query for each request."""

from __future__ import annotations

import logging
from datetime import datetime, timedelta

from sqlalchemy import select, update
from sqlalchemy.exc import SQLAlchemyError
from starlette.datastructures import Headers

from server.access.current_user import CurrentUser
from server.access.models import Account, LoginRow, TokenRow
from server.access.secrets import hash_secret
from server.database import Database, utc_now
from server.errors import LoginNeededError
from server.settings import Settings

log = logging.getLogger(__name__)

SEEN_EVERY = timedelta(minutes=1)
"""How often it is noted that a login or a token is in use."""

MAX_SECRET = 200

NOBODY = "You are not logged in, or no longer. Log in, or send a token: `Authorization: Bearer ...`."
NO_TOKEN = "The token is unknown, expired or revoked. Make a new one on the page of your account."


def name_cookie(settings: Settings) -> str:
    """Cookies know no ports: two studios on one machine need two names."""
    return f"handloom_login_{settings.port}"


def read_cookie(headers: Headers, settings: Settings) -> str | None:
    """The secret that a browser sends."""
    name, found = name_cookie(settings), None
    for header in headers.getlist("cookie"):
        for part in header.split(";"):
            key, _, value = part.strip().partition("=")
            if key == name and len(value) <= MAX_SECRET:
                found = found or value
    return found


def find_user(database: Database, headers: Headers, settings: Settings) -> tuple[CurrentUser, bool]:
    """Who makes a request, and whether it is to be noted that they were seen; raises for nobody we know.

    A token wins over a cookie, and counts where no login is needed too: a script that may only read stays one.
    """
    authorizations = headers.getlist("authorization")
    if authorizations:
        return _find_by_token(database, authorizations)
    secret = read_cookie(headers, settings)
    if not secret:
        raise LoginNeededError(NOBODY)
    query = (
        select(LoginRow.id, LoginRow.last_seen_at, Account.id, Account.name, Account.role)
        .join(Account, Account.id == LoginRow.account_id)
        .where(
            LoginRow.secret_hash == hash_secret("login", secret),
            LoginRow.expires_at > utc_now(),
            Account.disabled_at.is_(None),
        )
    )
    with database.reading() as session:
        row = session.execute(query).one_or_none()
    if row is None:
        raise LoginNeededError(NOBODY)
    login_id, seen_at, account_id, name, role = row
    return CurrentUser(account_id, name, role, login_id=login_id), _is_old(seen_at)


def _find_by_token(database: Database, authorizations: list[str]) -> tuple[CurrentUser, bool]:
    scheme, _, secret = authorizations[0].partition(" ")
    if len(authorizations) != 1 or scheme.lower() != "bearer" or not 0 < len(secret.strip()) <= MAX_SECRET:
        raise LoginNeededError("The Authorization header cannot be read; needed `Authorization: Bearer <token>`.")
    query = (
        select(TokenRow.id, TokenRow.last_used_at, TokenRow.may_write, Account.id, Account.name, Account.role)
        .join(Account, Account.id == TokenRow.account_id)
        .where(
            TokenRow.secret_hash == hash_secret("token", secret.strip()),
            TokenRow.revoked_at.is_(None),
            TokenRow.expires_at.is_(None) | (TokenRow.expires_at > utc_now()),
            Account.disabled_at.is_(None),
        )
    )
    with database.reading() as session:
        row = session.execute(query).one_or_none()
    if row is None:
        raise LoginNeededError(NO_TOKEN)
    token_id, used_at, may_write, account_id, name, role = row
    return CurrentUser(account_id, name, role, may_write=may_write, token_id=token_id), _is_old(used_at)


def _is_old(moment: datetime | None) -> bool:
    return moment is None or utc_now() - moment > SEEN_EVERY


def note_seen(database: Database, user: CurrentUser, settings: Settings) -> None:
    """Note that a login or token is in use, which keeps the login from expiring. Nobody waits for this."""
    now = utc_now()
    if user.login_id is not None:
        expires_at = now + timedelta(days=settings.login_days)
        change = update(LoginRow).where(LoginRow.id == user.login_id)
        change = change.values(last_seen_at=now, expires_at=expires_at)
    else:
        change = update(TokenRow).where(TokenRow.id == user.token_id).values(last_used_at=now)
    try:
        with database.writing() as session:
            session.execute(change)
    except SQLAlchemyError as error:
        log.warning("not noted that %s was seen: %s", user.account_id, type(error).__name__)
