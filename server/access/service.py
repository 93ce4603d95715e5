"""Who asks, and what they may do."""

from __future__ import annotations

import uuid
from collections.abc import Iterable
from typing import Annotated

from fastapi import Depends
from sqlalchemy import select
from sqlalchemy.orm import Session
from starlette.requests import HTTPConnection

from server.access.current_user import CurrentUser, read_current_user
from server.access.models import ROLES, Account, Role
from server.errors import ForbiddenError


async def get_current_user(connection: HTTPConnection) -> CurrentUser:
    """Who makes the request; the authentication found out before anything else was done."""
    return read_current_user(connection.scope)


CurrentUserDep = Annotated[CurrentUser, Depends(get_current_user)]


async def get_current_account(connection: HTTPConnection) -> Account:
    """The account of a request, to be read: id, name and role. It belongs to no session and costs no query."""
    user = read_current_user(connection.scope)
    return Account(id=user.account_id, name=user.name, role=user.role)


CurrentAccount = Annotated[Account, Depends(get_current_account)]


def has_role(account: Account, role: Role) -> bool:
    """Whether an account may do what this role may."""
    return ROLES.index(account.role) >= ROLES.index(role)


class RequireRole:
    """Dependency: the account of a request, which must have this role or a higher one."""

    def __init__(self, role: Role) -> None:
        self.role: Role = role

    async def __call__(self, account: CurrentAccount) -> Account:
        if not has_role(account, self.role):
            raise ForbiddenError(
                f"{account.name} is {account.role}; this needs {self.role} or higher. Ask a lead to do it or to change "
                "your role."
            )
        return account


require_lead = RequireRole("lead")
ReviewerAccount = Annotated[Account, Depends(RequireRole("reviewer"))]
LeadAccount = Annotated[Account, Depends(require_lead)]


async def require_person(user: CurrentUserDep) -> CurrentUser:
    """Dependency: a person, not a script. A stolen token must not make further tokens, nor people."""
    if user.token_id is not None:
        raise ForbiddenError("A token opens no account administration. Do it in a browser.")
    return user


PersonDep = Annotated[CurrentUser, Depends(require_person)]


async def get_current_account_id(user: CurrentUserDep) -> uuid.UUID:
    """The account's id, without a session: for routes that work longer than one transaction."""
    return user.account_id


AccountIdDep = Annotated[uuid.UUID, Depends(get_current_account_id)]


def find_names(session: Session, ids: Iterable[uuid.UUID | None]) -> dict[uuid.UUID | None, str]:
    """Names of some accounts; nobody (None) has none."""
    wanted = {id_ for id_ in ids if id_ is not None}
    if not wanted:
        return {}
    return {row.id: row.name for row in session.execute(select(Account.id, Account.name).where(Account.id.in_(wanted)))}
