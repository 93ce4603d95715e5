"""The audit trail: who did what, when."""

from __future__ import annotations

import uuid
from dataclasses import dataclass
from typing import Any

from sqlalchemy import select
from sqlalchemy.orm import Session

from server.access.models import AuditRow
from server.database.paging import fetch_page


def record_act(
    session: Session,
    account_id: uuid.UUID | None,
    act: str,
    subject: str,
    subject_id: uuid.UUID | None,
    **detail: Any,
) -> None:
    """Add a line to the audit trail, in the transaction of the act itself: both happen or neither.

    Args:
        account_id: Who; None for somebody not logged in.
        act: What, such as `assignment.submit`.
        subject: Kind of thing it was done to, such as `assignment`.
        subject_id: Which one.
        detail: Further values, ready for JSON.
    """
    session.add(AuditRow(account_id=account_id, act=act, subject=subject, subject_id=subject_id, detail=detail))


@dataclass(frozen=True)
class AuditFilter:
    """Which lines of the trail; None leaves a thing open."""

    account_id: uuid.UUID | None = None
    act: str | None = None
    subject: str | None = None
    subject_id: uuid.UUID | None = None


def list_acts(
    session: Session, which: AuditFilter, cursor: str | None, limit: int
) -> tuple[list[AuditRow], str | None]:
    """Lines of the trail, the newest first. `act` finds `assignment.submit` by `assignment` too."""
    query = select(AuditRow)
    if which.account_id is not None:
        query = query.where(AuditRow.account_id == which.account_id)
    if which.act is not None:
        query = query.where((AuditRow.act == which.act) | AuditRow.act.startswith(f"{which.act}.", autoescape=True))
    if which.subject is not None:
        query = query.where(AuditRow.subject == which.subject)
    if which.subject_id is not None:
        query = query.where(AuditRow.subject_id == which.subject_id)
    return fetch_page(session, query, (AuditRow.time, AuditRow.id), cursor, limit)
