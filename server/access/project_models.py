"""Tables of projects, assignments, comments and replica sets.

The room of the recordings stands above this one, so the type of their ids is said here.
"""

from __future__ import annotations

import uuid
from datetime import datetime
from typing import Any, Literal

from sqlalchemy import CheckConstraint, ForeignKey, Index, String, Text, UniqueConstraint, Uuid
from sqlalchemy.orm import Mapped, mapped_column

from server.database import Base, utc_now

AssignmentState = Literal["open", "submitted", "returned", "accepted"]


class ProjectRow(Base):
    """Recordings that belong together."""

    __tablename__ = "projects"

    name: Mapped[str] = mapped_column(String(200), unique=True)
    description: Mapped[str] = mapped_column(Text, default="")
    revision: Mapped[int] = mapped_column(default=1)
    created_at: Mapped[datetime] = mapped_column(default=utc_now)
    created_by: Mapped[uuid.UUID | None] = mapped_column(ForeignKey("accounts.id"))
    archived_at: Mapped[datetime | None]


class ProjectSequenceRow(Base):
    """A recording's place in a project."""

    __tablename__ = "project_sequences"
    __table_args__ = (UniqueConstraint("project_id", "sequence_id"),)

    project_id: Mapped[uuid.UUID] = mapped_column(ForeignKey("projects.id"))
    sequence_id: Mapped[uuid.UUID] = mapped_column(Uuid, ForeignKey("sequences.id"))
    added_at: Mapped[datetime] = mapped_column(default=utc_now)


class ReplicaSetRow(Base):
    """Frames that several people mark without seeing each other's joints."""

    __tablename__ = "replica_sets"

    project_id: Mapped[uuid.UUID] = mapped_column(ForeignKey("projects.id"))
    sequence_id: Mapped[uuid.UUID] = mapped_column(Uuid, ForeignKey("sequences.id"))
    name: Mapped[str] = mapped_column(String(200))
    frames: Mapped[list[Any]]
    cameras: Mapped[list[Any]]
    hands: Mapped[list[Any]]
    created_at: Mapped[datetime] = mapped_column(default=utc_now)
    created_by: Mapped[uuid.UUID | None] = mapped_column(ForeignKey("accounts.id"))
    deleted_at: Mapped[datetime | None]


class AssignmentRow(Base):
    """Frames that somebody is to mark: a range for everybody's annotations, or a replica set's frames blindly."""

    __tablename__ = "assignments"
    __table_args__ = (
        Index(None, "account_id", "state"),
        Index(None, "sequence_id"),
        CheckConstraint("state IN ('open', 'submitted', 'returned', 'accepted')", name="state"),
        CheckConstraint("frame_first >= 0 AND frame_last >= frame_first", name="frames"),
    )

    project_id: Mapped[uuid.UUID] = mapped_column(ForeignKey("projects.id"))
    sequence_id: Mapped[uuid.UUID] = mapped_column(Uuid, ForeignKey("sequences.id"))
    account_id: Mapped[uuid.UUID] = mapped_column(ForeignKey("accounts.id"))
    replica_set_id: Mapped[uuid.UUID | None] = mapped_column(ForeignKey("replica_sets.id"))
    """With one, the annotations go into the replica named by this assignment's id."""
    frame_first: Mapped[int]
    frame_last: Mapped[int]
    state: Mapped[AssignmentState] = mapped_column(String(10), default="open")
    note: Mapped[str] = mapped_column(Text, default="")
    revision: Mapped[int] = mapped_column(default=1)
    created_at: Mapped[datetime] = mapped_column(default=utc_now)
    created_by: Mapped[uuid.UUID | None] = mapped_column(ForeignKey("accounts.id"))
    updated_at: Mapped[datetime] = mapped_column(default=utc_now)
    reviewer_id: Mapped[uuid.UUID | None] = mapped_column(ForeignKey("accounts.id"))
    """Who accepted or returned it last."""
    deleted_at: Mapped[datetime | None]


class CommentRow(Base):
    """Something said about an assignment, or about one place in it."""

    __tablename__ = "assignment_comments"
    __table_args__ = (Index(None, "assignment_id"),)

    assignment_id: Mapped[uuid.UUID] = mapped_column(ForeignKey("assignments.id"))
    account_id: Mapped[uuid.UUID] = mapped_column(ForeignKey("accounts.id"))
    text: Mapped[str] = mapped_column(Text)
    camera: Mapped[str | None] = mapped_column(String(64))
    frame: Mapped[int | None]
    hand: Mapped[str | None] = mapped_column(String(5))
    joint: Mapped[int | None]
    created_at: Mapped[datetime] = mapped_column(default=utc_now)
    resolved_at: Mapped[datetime | None]
    resolved_by: Mapped[uuid.UUID | None] = mapped_column(ForeignKey("accounts.id"))
