"""Recordings."""

from __future__ import annotations

import uuid
from datetime import datetime
from typing import Any

from sqlalchemy import ForeignKey, Index, String
from sqlalchemy.orm import Mapped, mapped_column

from server.database import Base, utc_now


class SequenceRow(Base):
    """A recording whose files lie in `sequences/<id>/`, a recording folder as the tracker writes it.

    What people may change (name, hands) counts in the row, not in the folder's `sequence.json`.
    """

    __tablename__ = "sequences"
    __table_args__ = (Index(None, "created_at", "id"),)

    name: Mapped[str] = mapped_column(String(200))
    fps: Mapped[float]
    frame_count: Mapped[int]
    cameras: Mapped[list[Any]]
    """As `schemas.SequenceCamera`."""
    hands: Mapped[list[Any]]
    objects: Mapped[list[Any]]
    report: Mapped[dict[str, Any] | None]
    content_key: Mapped[str] = mapped_column(String(64))
    """Changes with any byte of its files; part of the address of every image."""
    revision: Mapped[int] = mapped_column(default=1)
    created_at: Mapped[datetime] = mapped_column(default=utc_now)
    updated_at: Mapped[datetime] = mapped_column(default=utc_now)
    deleted_at: Mapped[datetime | None]
    created_by: Mapped[uuid.UUID | None] = mapped_column(ForeignKey("accounts.id"))
