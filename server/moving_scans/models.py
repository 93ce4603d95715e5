"""Tables of moving scans and of the bodies that were registered to them."""

from __future__ import annotations

import uuid
from datetime import datetime
from typing import Any

from sqlalchemy import BigInteger, CheckConstraint, ForeignKey, Index, String, Text, UniqueConstraint
from sqlalchemy.orm import Mapped, mapped_column

from server.database import Base, utc_now

PRIORS = ("mixture", "gaussian", "none")


class MovingScanRow(Base):
    """Scans of one person in the order of time. The files in `moving_scans/<id>/` never change."""

    __tablename__ = "moving_scans"
    __table_args__ = (Index(None, "created_at", "id"), Index(None, "digest"))

    name: Mapped[str] = mapped_column(String(200))
    subject: Mapped[str] = mapped_column(String(100))
    fps: Mapped[float]
    frames: Mapped[list[Any]]
    """Of each frame `{"file", "name", "digest", "point_count", "problem"}`; `problem` says why it cannot be used."""
    frame_count: Mapped[int]
    usable_count: Mapped[int]
    digest: Mapped[str] = mapped_column(String(64))
    """SHA-256 of the files' digests in their order."""
    byte_count: Mapped[int] = mapped_column(BigInteger)
    metres_per_unit: Mapped[float]
    is_unit_guessed: Mapped[bool]
    box_m: Mapped[list[Any]]
    """Corners of the box around all frames: the lowest x, y, z and the highest."""
    notes: Mapped[list[Any]]
    created_at: Mapped[datetime] = mapped_column(default=utc_now)
    deleted_at: Mapped[datetime | None]
    created_by: Mapped[uuid.UUID | None] = mapped_column(ForeignKey("accounts.id"))


class MovingRegistrationRow(Base):
    """A stretch of a moving scan registered by one job with one prior; its frames are added while the job runs."""

    __tablename__ = "moving_registrations"
    __table_args__ = (
        Index(None, "moving_scan_id", "created_at"),
        Index(None, "job_id"),
        CheckConstraint("prior IN ('mixture', 'gaussian', 'none')", name="prior"),
    )

    moving_scan_id: Mapped[uuid.UUID] = mapped_column(ForeignKey(MovingScanRow.id))
    job_id: Mapped[uuid.UUID]
    parent_id: Mapped[uuid.UUID | None] = mapped_column(ForeignKey("moving_registrations.id"))
    """The registration that this one goes on from, with another prior."""
    template_id: Mapped[uuid.UUID]
    """Whose folder holds the person's own model: this one, the first of its ancestors, or a model made before."""
    prior: Mapped[str] = mapped_column(String(10))
    holds_hands: Mapped[bool]
    has_velocity: Mapped[bool]
    population: Mapped[str] = mapped_column(String(10))
    first_frame: Mapped[int]
    last_frame: Mapped[int]
    created_at: Mapped[datetime] = mapped_column(default=utc_now)
    created_by: Mapped[uuid.UUID | None] = mapped_column(ForeignKey("accounts.id"))


class FrameRegistrationRow(Base):
    """The body laid onto one frame. The files in `frame_registrations/<id>/` never change."""

    __tablename__ = "frame_registrations"
    __table_args__ = (
        UniqueConstraint("registration_id", "frame"),
        CheckConstraint("verdict IN ('good', 'doubtful', 'bad')", name="verdict"),
    )

    registration_id: Mapped[uuid.UUID] = mapped_column(ForeignKey(MovingRegistrationRow.id))
    frame: Mapped[int]
    digest: Mapped[str] = mapped_column(String(64))
    """SHA-256 of `body.npz`, hexadecimal."""
    verdict: Mapped[str] = mapped_column(String(10))
    reasons: Mapped[list[Any]]
    scan_to_mesh_mm: Mapped[dict[str, Any]]
    """mean, median, p95."""
    has_left: Mapped[bool]
    """Whether the scan shows the left hand; one that it does not show is guessed."""
    has_right: Mapped[bool]
    seconds: Mapped[float]
    created_at: Mapped[datetime] = mapped_column(default=utc_now)


class StretchDecisionRow(Base):
    """What somebody decided about frames of a registration. Rows are only ever added; an undo is a row too."""

    __tablename__ = "stretch_decisions"
    __table_args__ = (
        UniqueConstraint("operation_id"),
        UniqueConstraint("undoes_id"),
        UniqueConstraint("moving_scan_id", "number"),
        Index(None, "registration_id"),
        CheckConstraint("decision IN ('accept', 'reject', 'undo')", name="decision"),
        CheckConstraint("(decision = 'undo') = (undoes_id IS NOT NULL)", name="undo"),
        CheckConstraint("first_frame <= last_frame", name="stretch"),
    )

    moving_scan_id: Mapped[uuid.UUID] = mapped_column(ForeignKey(MovingScanRow.id))
    registration_id: Mapped[uuid.UUID] = mapped_column(ForeignKey(MovingRegistrationRow.id))
    number: Mapped[int]
    """Counts the decisions about a moving scan from 1; of two that stand about a frame, the higher one counts."""
    account_id: Mapped[uuid.UUID] = mapped_column(ForeignKey("accounts.id"))
    decision: Mapped[str] = mapped_column(String(10))
    first_frame: Mapped[int]
    last_frame: Mapped[int]
    note: Mapped[str] = mapped_column(Text)
    undoes_id: Mapped[uuid.UUID | None] = mapped_column(ForeignKey("stretch_decisions.id"))
    operation_id: Mapped[uuid.UUID]
    """The client's; a repeated request with it changes nothing and is answered alike."""
    created_at: Mapped[datetime] = mapped_column(default=utc_now)


class BodySetRow(Base):
    """Accepted frames of a moving scan, as they were when somebody kept them. It never changes."""

    __tablename__ = "body_sets"
    __table_args__ = (Index(None, "moving_scan_id", "created_at"), UniqueConstraint("moving_scan_id", "digest"))

    moving_scan_id: Mapped[uuid.UUID] = mapped_column(ForeignKey(MovingScanRow.id))
    name: Mapped[str] = mapped_column(String(200))
    digest: Mapped[str] = mapped_column(String(64))
    """SHA-256 of `members`, in a way of writing that is always the same."""
    frame_count: Mapped[int]
    members: Mapped[list[Any]]
    """`{"frame", "frame_registration_id", "digest", "decision_id"}` of each, in the order of frames."""
    created_at: Mapped[datetime] = mapped_column(default=utc_now)
    created_by: Mapped[uuid.UUID | None] = mapped_column(ForeignKey("accounts.id"))


class PersonModelRow(Base):
    """The model of a person, from a set. `moving_registrations/<id>/template.npz` never changes: it lies where those of
    registrations do, so that a registration takes either."""

    __tablename__ = "person_models"
    __table_args__ = (UniqueConstraint("body_set_id"),)

    body_set_id: Mapped[uuid.UUID] = mapped_column(ForeignKey(BodySetRow.id))
    name: Mapped[str] = mapped_column(String(200))
    population: Mapped[str] = mapped_column(String(10))
    digest: Mapped[str] = mapped_column(String(64))
    """SHA-256 of the file, hexadecimal."""
    frame_count: Mapped[int]
    """Frames of the set that it was made from."""
    created_at: Mapped[datetime] = mapped_column(default=utc_now)
    created_by: Mapped[uuid.UUID | None] = mapped_column(ForeignKey("accounts.id"))
