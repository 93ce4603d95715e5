"""The table of hand models that were trained or uploaded."""

from __future__ import annotations

import uuid
from datetime import datetime
from typing import Any

from sqlalchemy import CheckConstraint, ForeignKey, Index, String
from sqlalchemy.orm import Mapped, mapped_column

from server.database import Base, utc_now


class HandModelRow(Base):
    """A hand model that learns from scans. Its file `models/<id>/model.npz` never changes."""

    __tablename__ = "hand_models"
    __table_args__ = (
        Index(None, "created_at", "id"),
        CheckConstraint("kind IN ('untrained', 'trained', 'uploaded')", name="kind"),
        CheckConstraint("side IN ('right', 'left')", name="side"),
    )

    name: Mapped[str] = mapped_column(String(200))
    kind: Mapped[str] = mapped_column(String(10))
    side: Mapped[str] = mapped_column(String(5))
    digest: Mapped[str] = mapped_column(String(64))
    """SHA-256 of the file, hexadecimal."""
    facts: Mapped[dict[str, Any]]
    """What lists tell of it without opening the file: as fields of `schemas.HandModelOut`."""
    round: Mapped[int] = mapped_column(default=0)
    """0 for the first model, and one more for each training from registrations by the one before."""
    parent_id: Mapped[uuid.UUID | None] = mapped_column(ForeignKey("hand_models.id"))
    """The model that training began with."""
    training_set_id: Mapped[uuid.UUID | None] = mapped_column(ForeignKey("training_sets.id"))
    job_id: Mapped[uuid.UUID | None]
    report: Mapped[dict[str, Any] | None]
    """What training found."""
    created_at: Mapped[datetime] = mapped_column(default=utc_now)
    deleted_at: Mapped[datetime | None]
    created_by: Mapped[uuid.UUID | None] = mapped_column(ForeignKey("accounts.id"))
