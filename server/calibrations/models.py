"""The table of camera calibrations."""

from __future__ import annotations

import uuid
from datetime import datetime
from typing import Any

from sqlalchemy import BigInteger, CheckConstraint, ForeignKey, Index, String
from sqlalchemy.orm import Mapped, mapped_column

from server.database import Base, utc_now


class CalibrationRow(Base):
    """Films of a board, and what a job has made of them. Files of the result, `calibrations/<id>/`, never change."""

    __tablename__ = "calibrations"
    __table_args__ = (
        Index(None, "created_at", "id"),
        CheckConstraint("state IN ('checked', 'refused')", name="state"),
    )

    name: Mapped[str] = mapped_column(String(200))
    state: Mapped[str] = mapped_column(String(10))
    """Of the films, with these options."""
    options: Mapped[dict[str, Any]]
    report: Mapped[dict[str, Any]]
    """What looking at the films gave: cameras, problems, notes."""
    result: Mapped[dict[str, Any] | None]
    """What the job found, without the boards; null until it has succeeded."""
    films_id: Mapped[uuid.UUID]
    """The films lie in `films/<films_id>/` until nobody has touched a calibration of theirs for long."""
    job_id: Mapped[uuid.UUID | None]
    """The job that was started last."""
    file_count: Mapped[int]
    byte_count: Mapped[int] = mapped_column(BigInteger)
    created_at: Mapped[datetime] = mapped_column(default=utc_now)
    updated_at: Mapped[datetime] = mapped_column(default=utc_now)
    deleted_at: Mapped[datetime | None]
    created_by: Mapped[uuid.UUID | None] = mapped_column(ForeignKey("accounts.id"))
