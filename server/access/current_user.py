"""Who makes a request."""

from __future__ import annotations

import uuid
from dataclasses import dataclass

from starlette.types import Scope

from server.access.models import LOCAL_ACCOUNT_ID, Role

_PLACE = "user"


@dataclass(frozen=True)
class CurrentUser:
    """The account behind a request, and what it came in with.

    Attributes:
        may_write: False for a token that may only read.
        login_id: The browser's login, if it came with one.
        token_id: The script's token, if it came with one.
    """

    account_id: uuid.UUID
    name: str
    role: Role
    may_write: bool = True
    login_id: uuid.UUID | None = None
    token_id: uuid.UUID | None = None


LOCAL_USER = CurrentUser(LOCAL_ACCOUNT_ID, "local", "admin")
"""Whoever sits at this machine, where no login is asked for."""


def put_current_user(scope: Scope, user: CurrentUser) -> None:
    """Note who makes a request."""
    scope.setdefault("state", {})[_PLACE] = user


def read_current_user(scope: Scope) -> CurrentUser:
    """Who makes a request that was authenticated."""
    return scope["state"][_PLACE]
