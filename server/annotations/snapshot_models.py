"""The table of snapshots."""

from __future__ import annotations

import uuid
from datetime import datetime

from sqlalchemy import ForeignKey, Index, String
from sqlalchemy.orm import Mapped, mapped_column

from server.database import Base, utc_now


class SnapshotRow(Base):
    """Labels of a recording as they were. The file `snapshots/<id>.json` never changes; rows are only ever added."""

    __tablename__ = "label_snapshots"
    __table_args__ = (Index(None, "sequence_id", "created_at"),)

    sequence_id: Mapped[uuid.UUID] = mapped_column(ForeignKey("sequences.id"))
    version: Mapped[int]
    """Counts the snapshots of a recording from 1."""
    name: Mapped[str] = mapped_column(String(200))
    content_hash: Mapped[str] = mapped_column(String(64))
    """SHA-256 of the file, hexadecimal."""
    item_count: Mapped[int]
    joint_count: Mapped[int]
    created_at: Mapped[datetime] = mapped_column(default=utc_now)
    created_by: Mapped[uuid.UUID | None] = mapped_column(ForeignKey("accounts.id"))
