"""`/account`: who I am."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Body, Request, Response

from server.access.current_user import CurrentUser
from server.access.models import Account
from server.access.preferences import store_preferences
from server.access.schemas import MyAccount
from server.access.service import CurrentUserDep
from server.database import SessionDep
from server.database.revision import IfMatch, read_if_match, write_etag
from server.errors import error_responses

router = APIRouter(tags=["accounts"], responses=error_responses())


def describe_me(account: Account, user: CurrentUser, request: Request, response: Response) -> MyAccount:
    response.headers["ETag"] = write_etag(account.revision)
    return MyAccount(
        id=account.id,
        name=account.name,
        role=user.role,
        revision=account.revision,
        preferences=account.preferences,
        is_login_needed=request.app.state.settings.is_login_needed,
        may_write=user.may_write,
        by_token=user.token_id is not None,
    )


@router.get("/account")
def get_account(user: CurrentUserDep, session: SessionDep, request: Request, response: Response) -> MyAccount:
    """Who I am, with my preferences."""
    account = session.get_one(Account, user.account_id)
    return describe_me(account, user, request, response)


@router.put("/account/preferences", responses=error_responses(409, 413))
def put_preferences(
    body: Annotated[dict[str, Any], Body(description="Any JSON object of at most 64 kB; it replaces the old one.")],
    user: CurrentUserDep,
    session: SessionDep,
    request: Request,
    response: Response,
    if_match: IfMatch = None,
) -> MyAccount:
    """Replace my preferences. With `If-Match` only if they have not changed; without it the last one counts."""
    expected = None if if_match is None else read_if_match(if_match)
    account = store_preferences(session, user.account_id, body, expected)
    return describe_me(account, user, request, response)
