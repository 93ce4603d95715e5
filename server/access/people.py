"""Accounts of others: adding, roles, disabling."""

from __future__ import annotations

import re
import unicodedata
import uuid

from sqlalchemy import delete, func, select
from sqlalchemy.orm import Session

from server.access.audit import record_act
from server.access.logins import count_admins_who_can_log_in, end_logins
from server.access.models import LOCAL_ACCOUNT_ID, ROLES, Account, LoginRow, PasswordCodeRow, Role
from server.database import utc_now
from server.database.paging import fetch_page
from server.errors import ConflictError, ForbiddenError, InvalidError, NotFoundError

NAME = re.compile(r"[\w][\w .@+'-]{0,78}[\w.]|\w", re.UNICODE)


class StaleAccountError(ConflictError):
    """Somebody else changed the account."""


def check_name(name: str) -> str:
    """A name as it is kept; refused when it could be taken for something else."""
    plain = unicodedata.normalize("NFKC", name).strip()
    if not NAME.fullmatch(plain) or "  " in plain:
        raise InvalidError(
            f"The name {name[:80]!r} cannot be used; needed 1 to 80 letters, digits, spaces or . @ + - _ '."
        )
    return plain


def may_manage(actor: Account, role: Role) -> bool:
    """Whether somebody may manage accounts of a role: admins all, others those below their own."""
    return actor.role == "admin" or ROLES.index(role) < ROLES.index(actor.role)


def _check_may_manage(actor: Account, role: Role) -> None:
    if not may_manage(actor, role):
        raise ForbiddenError(f"{actor.name} is {actor.role} and may not manage a {role}. Ask an admin.")


def add_account(session: Session, actor: Account | None, name: str, role: Role) -> Account:
    """A new account, without a password yet; `actor` None is the command line."""
    name = check_name(name)
    if actor is not None:
        _check_may_manage(actor, role)
    # "Anna" and "anna" would be taken for each other
    if session.scalar(select(Account.id).where(func.lower(Account.name) == name.lower())) is not None:
        raise ConflictError(f"There is already an account {name!r}. Choose another name.")
    account = Account(name=name, role=role)
    session.add(account)
    session.flush()
    record_act(session, actor and actor.id, "account.add", "account", account.id, name=name, role=role)
    return account


def get_account(session: Session, account_id: uuid.UUID) -> Account:
    """One account, to be changed."""
    account = session.get(Account, account_id, with_for_update=True)
    if account is None:
        raise NotFoundError("There is no such account.")
    return account


def get_managed(session: Session, actor: Account, account_id: uuid.UUID) -> Account:
    """One account that somebody may manage."""
    account = get_account(session, account_id)
    _check_may_manage(actor, account.role)
    if account.id == LOCAL_ACCOUNT_ID:
        raise ForbiddenError("The account `local` is whoever sits at the studio's machine; it cannot be changed.")
    return account


def change_account(
    session: Session,
    actor: Account,
    account_id: uuid.UUID,
    expected: int,
    role: Role | None = None,
    is_disabled: bool | None = None,
) -> Account:
    """Change the role of an account, or disable or enable it; its work is kept."""
    account = get_managed(session, actor, account_id)
    if expected != account.revision:
        raise StaleAccountError(
            f"The account is at revision {account.revision} now, not {expected}. Load it again.",
            headers={"ETag": f'"{account.revision}"'},
        )
    if account.id == actor.id:
        raise ForbiddenError("Nobody can change the role of their own account or disable it. Ask another admin.")
    if role is not None and role != account.role:
        _check_may_manage(actor, role)
        record_act(session, actor.id, "account.role", "account", account.id, before=account.role, after=role)
        account.role = role
    if is_disabled is not None and is_disabled != (account.disabled_at is not None):
        set_disabled(session, actor.id, account, is_disabled)
    account.revision += 1
    session.flush()
    return account


def set_disabled(session: Session, actor_id: uuid.UUID | None, account: Account, is_disabled: bool) -> None:
    """Disable an account, so that its logins, tokens and codes end; or enable it."""
    account.disabled_at = utc_now() if is_disabled else None
    if is_disabled:
        end_logins(session, account.id)
        session.execute(delete(PasswordCodeRow).where(PasswordCodeRow.account_id == account.id))
    act = "account.disable" if is_disabled else "account.enable"
    record_act(session, actor_id, act, "account", account.id)
    session.flush()


def check_an_admin_is_left(session: Session) -> None:
    """Raise when no admin could log in any more; the transaction must then not be committed."""
    if count_admins_who_can_log_in(session) == 0:
        raise ConflictError("This is the last admin who can log in. Make somebody else admin first.")


def list_accounts(session: Session, cursor: str | None, limit: int) -> tuple[list[Account], str | None]:
    """Accounts by name."""
    order = (func.lower(Account.name), Account.id)
    return fetch_page(session, select(Account), order, cursor, limit, is_falling=False)


def find_last_seen(session: Session, account_ids: list[uuid.UUID]) -> dict:
    """When each was last seen in a browser."""
    query = select(LoginRow.account_id, func.max(LoginRow.last_seen_at)).where(LoginRow.account_id.in_(account_ids))
    return {row[0]: row[1] for row in session.execute(query.group_by(LoginRow.account_id))}
