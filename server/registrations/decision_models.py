"""The table of decisions."""

from __future__ import annotations

import uuid
from datetime import datetime
from typing import Any

from sqlalchemy import CheckConstraint, ForeignKey, Index, String, Text, UniqueConstraint
from sqlalchemy.orm import Mapped, mapped_column

from server.database import Base, utc_now
from server.hand_models.models import HandModelRow
from server.registrations.models import RegistrationRow


class DecisionRow(Base):
    """One thing that somebody decided about a registration. Rows are only ever added; an undo is a row too."""

    __tablename__ = "decisions"
    __table_args__ = (
        UniqueConstraint("operation_id"),
        UniqueConstraint("undoes_id"),
        Index(None, "registration_id"),
        Index(None, "account_id", "created_at"),
        Index(None, "created_at", "id"),
        CheckConstraint("decision IN ('accept', 'reject', 'unsure', 'undo')", name="decision"),
        CheckConstraint("(decision = 'undo') = (undoes_id IS NOT NULL)", name="undo"),
    )

    registration_id: Mapped[uuid.UUID] = mapped_column(ForeignKey(RegistrationRow.id))
    account_id: Mapped[uuid.UUID] = mapped_column(ForeignKey("accounts.id"))
    model_id: Mapped[uuid.UUID] = mapped_column(ForeignKey(HandModelRow.id))
    """The model version that was judged."""
    number: Mapped[int]
    """Counts the decisions about a registration from 1."""
    decision: Mapped[str] = mapped_column(String(10))
    undoes_id: Mapped[uuid.UUID | None] = mapped_column(ForeignKey("decisions.id"))
    reasons: Mapped[list[Any]]
    note: Mapped[str] = mapped_column(Text)
    seconds: Mapped[float | None]
    """How long it was looked at, as the page says."""
    is_blind: Mapped[bool]
    """Whether the person could not see what others had decided."""
    operation_id: Mapped[uuid.UUID]
    """The client's; a repeated request with it changes nothing and is answered alike."""
    created_at: Mapped[datetime] = mapped_column(default=utc_now)
