"""Tables of training sets."""

from __future__ import annotations

import uuid
from datetime import datetime
from typing import Any

from sqlalchemy import ForeignKey, Index, String, UniqueConstraint
from sqlalchemy.orm import Mapped, mapped_column

from server.database import Base, utc_now
from server.registrations.decision_models import DecisionRow
from server.registrations.models import RegistrationRow


class TrainingSetRow(Base):
    """Registrations as a rule chose them at one moment; the file `training_sets/<id>.json` names them for good."""

    __tablename__ = "training_sets"
    __table_args__ = (Index(None, "created_at", "id"),)

    name: Mapped[str] = mapped_column(String(200))
    rule: Mapped[dict[str, Any]]
    """As `schemas.TrainingRule`."""
    digest: Mapped[str] = mapped_column(String(64))
    """SHA-256 of the file, hexadecimal."""
    registration_count: Mapped[int]
    subject_count: Mapped[int]
    mirrored_count: Mapped[int]
    """Left hands."""
    created_at: Mapped[datetime] = mapped_column(default=utc_now)
    created_by: Mapped[uuid.UUID | None] = mapped_column(ForeignKey("accounts.id"))


class TrainingMemberRow(Base):
    """A registration's place in a training set."""

    __tablename__ = "training_members"
    __table_args__ = (UniqueConstraint("training_set_id", "registration_id"), Index(None, "registration_id"))

    training_set_id: Mapped[uuid.UUID] = mapped_column(ForeignKey("training_sets.id"))
    registration_id: Mapped[uuid.UUID] = mapped_column(ForeignKey(RegistrationRow.id))
    decision_id: Mapped[uuid.UUID | None] = mapped_column(ForeignKey(DecisionRow.id))
    """The decision that it was taken by; None when the program's own verdict was."""
