"""Annotations and their history."""

from __future__ import annotations

import uuid
from datetime import datetime
from typing import Any, Literal

from sqlalchemy import CheckConstraint, ForeignKey, Index, String, UniqueConstraint
from sqlalchemy.orm import Mapped, mapped_column

from server.database import Base, utc_now

Act = Literal["put", "delete", "restore", "import"]


class AnnotationRow(Base):
    """One hand in one image as it is now. A deleted one stays, without points, so that its revisions go on counting."""

    __tablename__ = "annotations"
    __table_args__ = (
        UniqueConstraint("sequence_id", "replica", "camera", "frame", "hand"),
        Index(None, "sequence_id", "updated_at"),
        CheckConstraint("hand IN ('right', 'left')", name="hand"),
        CheckConstraint("frame >= 0", name="frame"),
    )

    sequence_id: Mapped[uuid.UUID] = mapped_column(ForeignKey("sequences.id"))
    replica: Mapped[str] = mapped_column(String(36), default="")
    """Empty for the annotations that everybody sees; else the assignment whose annotator marks the frame blindly."""
    camera: Mapped[str] = mapped_column(String(64))
    frame: Mapped[int]
    hand: Mapped[str] = mapped_column(String(5))
    points: Mapped[list[Any] | None]
    """21 times [x, y, v], px; None when deleted."""
    sources: Mapped[list[Any] | None]
    """As `sources.py`; None where they were never noted."""
    decided: Mapped[int] = mapped_column(default=0)
    """Joints that somebody placed or said are not in the image, 0 to 21."""
    revision: Mapped[int]
    updated_at: Mapped[datetime] = mapped_column(default=utc_now)
    author_id: Mapped[uuid.UUID | None] = mapped_column(ForeignKey("accounts.id"))


class AnnotationRevisionRow(Base):
    """What one operation made of an annotation. Rows are only ever added."""

    __tablename__ = "annotation_revisions"
    __table_args__ = (
        UniqueConstraint("annotation_id", "revision"),
        UniqueConstraint("operation_id"),
        CheckConstraint("act IN ('put', 'delete', 'restore', 'import')", name="act"),
    )

    annotation_id: Mapped[uuid.UUID] = mapped_column(ForeignKey("annotations.id"))
    revision: Mapped[int]
    operation_id: Mapped[uuid.UUID]
    """The client's; a repeated request with it changes nothing and is answered alike."""
    act: Mapped[str] = mapped_column(String(10))
    points: Mapped[list[Any] | None]
    sources: Mapped[list[Any] | None]
    created_at: Mapped[datetime] = mapped_column(default=utc_now)
    author_id: Mapped[uuid.UUID | None] = mapped_column(ForeignKey("accounts.id"))


class KeyFrameRow(Base):
    """One hand in one image that is a key frame."""

    __tablename__ = "key_frames"
    __table_args__ = (UniqueConstraint("sequence_id", "replica", "camera", "frame", "hand"),)

    sequence_id: Mapped[uuid.UUID] = mapped_column(ForeignKey("sequences.id"))
    replica: Mapped[str] = mapped_column(String(36), default="")
    camera: Mapped[str] = mapped_column(String(64))
    frame: Mapped[int]
    hand: Mapped[str] = mapped_column(String(5))
    created_at: Mapped[datetime] = mapped_column(default=utc_now)
    created_by: Mapped[uuid.UUID | None] = mapped_column(ForeignKey("accounts.id"))
