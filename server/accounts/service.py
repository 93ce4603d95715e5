"""Who asks."""

from __future__ import annotations

import uuid
from collections.abc import Iterable
from typing import Annotated

from fastapi import Depends
from sqlalchemy import select
from sqlalchemy.orm import Session

from server.accounts.models import LOCAL_ACCOUNT_ID, ROLES, Account, Role
from server.database import SessionDep
from server.errors import ForbiddenError


def get_current_account(session: SessionDep) -> Account:
    """The account of a request: the local one, since only this machine can reach the studio."""
    account = session.get(Account, LOCAL_ACCOUNT_ID)
    assert account is not None, "the first migration makes the local account"
    return account


CurrentAccount = Annotated[Account, Depends(get_current_account)]


def has_role(account: Account, role: Role) -> bool:
    """Whether an account may do what this role may."""
    return ROLES.index(account.role) >= ROLES.index(role)


class RequireRole:
    """Dependency: the account of a request, which must have this role or a higher one."""

    def __init__(self, role: Role) -> None:
        self.role: Role = role

    def __call__(self, account: CurrentAccount) -> Account:
        if not has_role(account, self.role):
            raise ForbiddenError(
                f"{account.name} is {account.role}; this needs {self.role} or higher. Ask a lead to do it or to change "
                "your role."
            )
        return account


ReviewerAccount = Annotated[Account, Depends(RequireRole("reviewer"))]
LeadAccount = Annotated[Account, Depends(RequireRole("lead"))]
AdminAccount = Annotated[Account, Depends(RequireRole("admin"))]


def get_current_account_id() -> uuid.UUID:
    """The account's id, without a session: for routes that work longer than one transaction."""
    return LOCAL_ACCOUNT_ID


AccountIdDep = Annotated[uuid.UUID, Depends(get_current_account_id)]


def find_names(session: Session, ids: Iterable[uuid.UUID | None]) -> dict[uuid.UUID | None, str]:
    """Names of some accounts; nobody (None) has none."""
    wanted = {id_ for id_ in ids if id_ is not None}
    if not wanted:
        return {}
    return {row.id: row.name for row in session.execute(select(Account.id, Account.name).where(Account.id.in_(wanted)))}
