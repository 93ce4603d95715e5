"""Who makes a request."""

from __future__ import annotations

import uuid
from dataclasses import dataclass

from starlette.types import Scope

from server.accounts.models import LOCAL_ACCOUNT_ID, Role

_PLACE = "visitor"


@dataclass(frozen=True)
class Visitor:
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


LOCAL_VISITOR = Visitor(LOCAL_ACCOUNT_ID, "local", "admin")
"""Whoever sits at this machine, where no login is asked for."""


def put_visitor(scope: Scope, visitor: Visitor) -> None:
    """Note who makes a request."""
    scope.setdefault("state", {})[_PLACE] = visitor


def read_visitor(scope: Scope) -> Visitor:
    """Who makes a request that the door let in."""
    return scope["state"][_PLACE]
