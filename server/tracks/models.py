"""The table of tracks."""

from __future__ import annotations

import uuid
from datetime import datetime
from typing import Any

from sqlalchemy import ForeignKey, Index, String
from sqlalchemy.orm import Mapped, mapped_column

from server.database import Base, utc_now


class TrackRow(Base):
    """Poses of hands and objects over frames of a recording. The arrays are in the folder of this id."""

    __tablename__ = "tracks"
    __table_args__ = (
        Index(None, "sequence_id"),
        Index(None, "created_at", "id"),
    )

    sequence_id: Mapped[uuid.UUID] = mapped_column(ForeignKey("sequences.id"))
    job_id: Mapped[uuid.UUID | None]
    name: Mapped[str] = mapped_column(String(200))
    frame_first: Mapped[int]
    frame_count: Mapped[int]
    hands: Mapped[list[Any]]
    summary: Mapped[dict[str, Any]]
    error_px: Mapped[float | None]
    """Mean distance to the annotations that no track had a part in, when last evaluated, px."""
    cameras_digest: Mapped[str | None] = mapped_column(String(64))
    """Of the cameras that it was made with (`cameras.py`)."""
    created_at: Mapped[datetime] = mapped_column(default=utc_now)
    deleted_at: Mapped[datetime | None]
