"""Logging in and out, one's password and the browsers one is logged in with."""

from __future__ import annotations

import uuid
from datetime import timedelta
from typing import Annotated

from fastapi import APIRouter, Depends, Request, Response
from sqlalchemy import delete, select
from starlette.requests import HTTPConnection

from server.access import logins
from server.access.authentication import name_cookie, read_cookie
from server.access.current_user import CurrentUser
from server.access.login_throttle import LoginThrottle
from server.access.logins import Browser
from server.access.models import Account, LoginRow
from server.access.routes import describe_me
from server.access.schemas import CodeIn, LoginIn, LoginOut, MyAccount, PasswordIn
from server.access.secrets import hash_secret
from server.access.service import PersonDep
from server.database import Database, DatabaseDep, SessionDep, utc_now
from server.database.paging import Page
from server.errors import NotFoundError, error_responses

router = APIRouter(tags=["accounts"], responses=error_responses())

COOKIE_LIFE = timedelta(days=400)
"""As long as browsers keep one at most; the studio ends logins much sooner."""


async def get_tries(connection: HTTPConnection) -> LoginThrottle:
    """The app's."""
    return connection.app.state.login_throttle


LoginThrottleDep = Annotated[LoginThrottle, Depends(get_tries)]


async def get_browser(connection: HTTPConnection) -> Browser:
    """Where the request comes from."""
    return Browser(
        address=connection.client.host if connection.client else "",
        user_agent=connection.headers.get("user-agent", ""),
        life=timedelta(days=connection.app.state.settings.login_days),
    )


BrowserDep = Annotated[Browser, Depends(get_browser)]


@router.post("/login", responses=error_responses(429))
def log_in(
    body: LoginIn,
    database: DatabaseDep,
    throttle: LoginThrottleDep,
    browser: BrowserDep,
    request: Request,
    response: Response,
) -> MyAccount:
    """Log in; the answer sets the cookie."""
    account_id, secret = logins.log_in(database, throttle, body.name, body.password, browser)
    return _welcome(database, account_id, secret, request, response)


@router.post("/login/code", responses=error_responses(429))
def log_in_with_code(
    body: CodeIn,
    database: DatabaseDep,
    throttle: LoginThrottleDep,
    browser: BrowserDep,
    request: Request,
    response: Response,
) -> MyAccount:
    """Set one's password with a one-time code, and log in."""
    account_id, secret = logins.redeem_code(database, throttle, body.code, body.password, browser)
    return _welcome(database, account_id, secret, request, response)


def _welcome(database: Database, account_id: uuid.UUID, secret: str, request: Request, response: Response) -> MyAccount:
    settings = request.app.state.settings
    with database.writing() as session:
        if earlier := read_cookie(request.headers, settings):
            session.execute(delete(LoginRow).where(LoginRow.secret_hash == hash_secret("login", earlier)))
        account = session.get_one(Account, account_id)
    response.set_cookie(
        name_cookie(settings),
        secret,
        max_age=int(COOKIE_LIFE.total_seconds()),
        httponly=True,
        samesite="strict",
        secure=_is_https(request),
    )
    return describe_me(account, CurrentUser(account.id, account.name, account.role), request, response)


def _is_https(request: Request) -> bool:
    """A proxy may speak TLS for the studio: then the page's origin tells."""
    return request.url.scheme == "https" or request.headers.get("origin", "").lower().startswith("https://")


def _forget_cookie(request: Request, response: Response) -> None:
    name = name_cookie(request.app.state.settings)
    response.delete_cookie(name, httponly=True, samesite="strict", secure=_is_https(request))


@router.post("/logout", status_code=204)
def log_out(person: PersonDep, session: SessionDep, request: Request, response: Response) -> None:
    """Log out in this browser."""
    session.execute(delete(LoginRow).where(LoginRow.id == person.login_id))
    _forget_cookie(request, response)


@router.post("/logout/everywhere", status_code=204)
def log_out_everywhere(person: PersonDep, session: SessionDep, request: Request, response: Response) -> None:
    """Log out in every browser. Tokens of scripts stay valid."""
    logins.end_logins(session, person.account_id)
    _forget_cookie(request, response)


@router.put("/account/password", status_code=204, responses=error_responses(429))
def change_password(body: PasswordIn, person: PersonDep, database: DatabaseDep, throttle: LoginThrottleDep) -> None:
    """Change my password. Other browsers must log in again."""
    logins.change_password(database, throttle, person.account_id, body.current, body.new, person.login_id)


@router.get("/account/logins")
def list_logins(person: PersonDep, session: SessionDep) -> Page[LoginOut]:
    """Browsers in which I am logged in, the last used first."""
    query = select(LoginRow).where(LoginRow.account_id == person.account_id, LoginRow.expires_at > utc_now())
    rows = session.scalars(query.order_by(LoginRow.last_seen_at.desc(), LoginRow.id))
    items = [LoginOut.model_validate(row).model_copy(update={"is_this": row.id == person.login_id}) for row in rows]
    return Page(items=items, next_cursor=None)


@router.delete("/account/logins/{login_id}", status_code=204, responses=error_responses(404))
def end_login(login_id: uuid.UUID, person: PersonDep, session: SessionDep) -> None:
    """Log out in one of my browsers."""
    row = session.get(LoginRow, login_id)
    if row is None or row.account_id != person.account_id:
        raise NotFoundError("You are not logged in there, or no longer.")
    session.delete(row)
