"""Scans and what was cropped from them."""

from __future__ import annotations

import uuid
from datetime import datetime
from typing import Any

from sqlalchemy import BigInteger, CheckConstraint, ForeignKey, Index, String, Text, UniqueConstraint
from sqlalchemy.orm import Mapped, mapped_column

from server.database import Base, utc_now


class ScanRow(Base):
    """A 3D scan of a hand. Its file lies in `scans/<id>/` as it was uploaded and never changes."""

    __tablename__ = "scans"
    __table_args__ = (
        Index(None, "created_at", "id"),
        Index(None, "collection", "subject"),
        Index(None, "digest"),
        CheckConstraint("state IN ('new', 'registered', 'failed')", name="state"),
        CheckConstraint("side IN ('right', 'left')", name="side"),
    )

    name: Mapped[str] = mapped_column(String(200))
    collection: Mapped[str] = mapped_column(String(200))
    """Scans that belong together carry the same text here."""
    subject: Mapped[str] = mapped_column(String(100))
    pose: Mapped[str] = mapped_column(String(100))
    side: Mapped[str | None] = mapped_column(String(5))
    """As the uploader says; None leaves it to the registration."""
    state: Mapped[str] = mapped_column(String(10), default="new")
    """`failed`: the last registration could not even be tried; `problem` says why."""
    problem: Mapped[str | None] = mapped_column(Text)
    file: Mapped[str] = mapped_column(String(20))
    """Such as `scan.ply`."""
    digest: Mapped[str] = mapped_column(String(64))
    """SHA-256 of the file, hexadecimal."""
    byte_count: Mapped[int] = mapped_column(BigInteger)
    point_count: Mapped[int]
    face_count: Mapped[int]
    has_colors: Mapped[bool]
    extent_m: Mapped[list[Any]]
    """Of its box along x, y and z."""
    size_m: Mapped[list[Any] | None]
    """Sides of a box along what is registered, the longest first; None in rows older than migration 0012."""
    metres_per_unit: Mapped[float | None]
    """Of the file. None in rows of before migration 0012 for which nobody said it: `extent_m` tells."""
    first_metres_per_unit: Mapped[float | None]
    """As it was uploaded; None likewise."""
    is_unit_guessed: Mapped[bool] = mapped_column(default=False)
    """The unit was not given; it was recognised by the size."""
    notes: Mapped[list[Any]]
    """What was noticed when it was read, sentences."""
    revision: Mapped[int] = mapped_column(default=1)
    """Of what is cropped and of the unit: 1 is the scan as it was uploaded."""
    removed_count: Mapped[int] = mapped_column(default=0)
    """Points that are left out now."""
    created_at: Mapped[datetime] = mapped_column(default=utc_now)
    deleted_at: Mapped[datetime | None]
    created_by: Mapped[uuid.UUID | None] = mapped_column(ForeignKey("accounts.id"))


class ScanCropRow(Base):
    """What is left out of a scan, and its unit, as of one revision. Rows are only ever added."""

    __tablename__ = "scan_crops"
    __table_args__ = (UniqueConstraint("scan_id", "revision"),)

    scan_id: Mapped[uuid.UUID] = mapped_column(ForeignKey("scans.id"))
    revision: Mapped[int]
    strokes: Mapped[list[Any]]
    """As `schemas.Stroke`."""
    drops_objects: Mapped[bool]
    """Whether points of an object, known by its colour, are left out too."""
    removed_count: Mapped[int]
    """Points that are left out."""
    metres_per_unit: Mapped[float | None]
    """Of the scan's file as of this revision; None is as it was uploaded."""
    created_at: Mapped[datetime] = mapped_column(default=utc_now)
    author_id: Mapped[uuid.UUID | None] = mapped_column(ForeignKey("accounts.id"))
