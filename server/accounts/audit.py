"""The audit trail: who did what, when."""

from __future__ import annotations

import uuid
from typing import Any

from sqlalchemy.orm import Session

from server.accounts.models import AuditRow


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
