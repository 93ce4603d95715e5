"""Uploads."""

from __future__ import annotations

import uuid
from datetime import datetime
from typing import Any

from sqlalchemy import BigInteger, CheckConstraint, ForeignKey, String
from sqlalchemy.orm import Mapped, mapped_column

from server.database import Base, utc_now


class ImportRow(Base):
    """An upload whose files lie in `uploads/<id>/` until it is confirmed or dropped."""

    __tablename__ = "imports"
    __table_args__ = (CheckConstraint("state IN ('checked', 'refused', 'confirmed')", name="state"),)

    state: Mapped[str] = mapped_column(String(10))
    name: Mapped[str] = mapped_column(String(200))
    """Proposed for the recording, made from what was dropped."""
    options: Mapped[dict[str, Any]]
    report: Mapped[dict[str, Any]]
    file_count: Mapped[int]
    byte_count: Mapped[int] = mapped_column(BigInteger)
    sequence_id: Mapped[uuid.UUID | None] = mapped_column(ForeignKey("sequences.id"))
    calibration_id: Mapped[uuid.UUID | None]
    """The kept calibration whose cameras lie beside the files."""
    created_at: Mapped[datetime] = mapped_column(default=utc_now)
    updated_at: Mapped[datetime] = mapped_column(default=utc_now)
    created_by: Mapped[uuid.UUID | None] = mapped_column(ForeignKey("accounts.id"))
