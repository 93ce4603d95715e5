"""Tokens: the way in for scripts."""

from __future__ import annotations

import uuid
from datetime import timedelta

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from server.access.audit import record_act
from server.access.models import TokenRow
from server.access.secrets import hash_secret, make_secret
from server.database import utc_now
from server.errors import ConflictError, NotFoundError

MAX_TOKENS = 100
"""Of one account that are not revoked."""


def add_token(
    session: Session, account_id: uuid.UUID, name: str, may_write: bool, days: float | None
) -> tuple[TokenRow, str]:
    """A new token and its secret, which is nowhere later."""
    held = select(func.count()).select_from(TokenRow)
    held = held.where(TokenRow.account_id == account_id, TokenRow.revoked_at.is_(None))
    if (session.scalar(held) or 0) >= MAX_TOKENS:
        raise ConflictError(f"You have {MAX_TOKENS} tokens already. Revoke one that is not used.")
    secret = make_secret("token")
    row = TokenRow(
        account_id=account_id,
        name=name,
        secret_hash=hash_secret("token", secret),
        may_write=may_write,
        expires_at=None if days is None else utc_now() + timedelta(days=days),
    )
    session.add(row)
    session.flush()
    record_act(session, account_id, "token.add", "token", row.id, name=name, may_write=may_write)
    return row, secret


def list_tokens(session: Session, account_id: uuid.UUID) -> list[TokenRow]:
    """Tokens of an account that are not revoked, the newest first."""
    query = select(TokenRow).where(TokenRow.account_id == account_id, TokenRow.revoked_at.is_(None))
    return list(session.scalars(query.order_by(TokenRow.created_at.desc(), TokenRow.id)))


def revoke_token(session: Session, account_id: uuid.UUID, token_id: uuid.UUID) -> None:
    """End a token of an account; at once, and for good."""
    row = session.get(TokenRow, token_id)
    if row is None or row.account_id != account_id:
        raise NotFoundError("You have no such token.")
    if row.revoked_at is None:
        row.revoked_at = utc_now()
        record_act(session, account_id, "token.revoke", "token", row.id, name=row.name)
    session.flush()
