"""The table of refined cameras."""

from __future__ import annotations

import uuid
from datetime import datetime
from typing import Any

from sqlalchemy import CheckConstraint, ForeignKey, Index, String
from sqlalchemy.orm import Mapped, mapped_column

from server.database import Base, utc_now


class RefinementRow(Base):
    """What labels made of a recording's cameras. It goes on holding the cameras before and after, whatever follows."""

    __tablename__ = "refinements"
    __table_args__ = (
        Index(None, "sequence_id", "created_at"),
        CheckConstraint("state IN ('proposed', 'taken', 'put_back')", name="state"),
    )

    sequence_id: Mapped[uuid.UUID] = mapped_column(ForeignKey("sequences.id"))
    state: Mapped[str] = mapped_column(String(10), default="proposed")
    report: Mapped[dict[str, Any]]
    """As the tracker's `Refinement.to_json` has it."""
    cameras_before: Mapped[list[Any]]
    """As `sequences.schemas.SequenceCamera`."""
    cameras_after: Mapped[list[Any]]
    created_at: Mapped[datetime] = mapped_column(default=utc_now)
    created_by: Mapped[uuid.UUID | None] = mapped_column(ForeignKey("accounts.id"))
    changed_at: Mapped[datetime | None]
    """When it was taken or put back."""
    changed_by: Mapped[uuid.UUID | None] = mapped_column(ForeignKey("accounts.id"))
