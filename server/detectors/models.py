"""The table of fingertip detectors."""

from __future__ import annotations

import uuid
from datetime import datetime

from sqlalchemy import BigInteger, CheckConstraint, ForeignKey, Index, String
from sqlalchemy.orm import Mapped, mapped_column

from server.database import Base, utc_now


class DetectorRow(Base):
    """A fingertip detector that somebody uploaded. Its file `detectors/<id>/detector.npz` never changes."""

    __tablename__ = "detectors"
    __table_args__ = (
        Index(None, "created_at", "id"),
        CheckConstraint("looks_at IN ('depth', 'color')", name="looks_at"),
    )

    name: Mapped[str] = mapped_column(String(200))
    looks_at: Mapped[str] = mapped_column(String(5))
    trees: Mapped[int]
    byte_count: Mapped[int] = mapped_column(BigInteger)
    digest: Mapped[str] = mapped_column(String(64))
    """SHA-256 of the file, hexadecimal."""
    created_at: Mapped[datetime] = mapped_column(default=utc_now)
    deleted_at: Mapped[datetime | None]
    created_by: Mapped[uuid.UUID | None] = mapped_column(ForeignKey("accounts.id"))
