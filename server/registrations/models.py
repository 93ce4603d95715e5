"""The table of registrations."""

from __future__ import annotations

import uuid
from datetime import datetime
from typing import Any

from sqlalchemy import CheckConstraint, ForeignKey, Index, String
from sqlalchemy.orm import Mapped, mapped_column

from server.database import Base, utc_now
from server.hand_models.models import HandModelRow
from server.scans.models import ScanRow


class RegistrationRow(Base):
    """The template brought onto a scan by one hand model. The files in `registrations/<id>/` never change."""

    __tablename__ = "registrations"
    __table_args__ = (
        Index(None, "created_at", "id"),
        Index(None, "scan_id"),
        Index(None, "model_id"),
        Index(None, "job_id"),
        Index(None, "is_current", "decision", "score"),
        CheckConstraint("verdict IN ('good', 'doubtful', 'bad')", name="verdict"),
        CheckConstraint("decision IN ('accept', 'reject', 'unsure')", name="decision"),
        CheckConstraint("side IN ('right', 'left')", name="side"),
    )

    scan_id: Mapped[uuid.UUID] = mapped_column(ForeignKey(ScanRow.id))
    model_id: Mapped[uuid.UUID] = mapped_column(ForeignKey(HandModelRow.id))
    job_id: Mapped[uuid.UUID | None]
    round: Mapped[int]
    """1 for registrations by an untrained model, and one more than its round for a trained one."""
    crop_revision: Mapped[int]
    """Of the scan, when it was registered."""
    digest: Mapped[str] = mapped_column(String(64))
    """SHA-256 of `registration.npz`, hexadecimal."""
    side: Mapped[str] = mapped_column(String(5))
    """As found."""
    verdict: Mapped[str] = mapped_column(String(10))
    score: Mapped[float]
    """Chance that it is wrong, as the registration judges itself, 0 to 1."""
    reasons: Mapped[list[Any]]
    scan_to_mesh_mm: Mapped[dict[str, Any]]
    """mean, median, p95."""
    seconds: Mapped[float]
    is_current: Mapped[bool] = mapped_column(default=True)
    """Whether it is the newest one of its scan that is not outdated."""
    is_outdated: Mapped[bool] = mapped_column(default=False)
    """Whether the scan has another size by now: somebody corrected the unit of its file."""
    decision: Mapped[str | None] = mapped_column(String(10))
    """The last one of anybody that stands; copied here from `decisions` in the transaction that adds one."""
    standing: Mapped[dict[str, Any]] = mapped_column(default=dict)
    """What each person's decision is, by the account's id: `{"id", "decision"}`."""
    reviewer_count: Mapped[int] = mapped_column(default=0)
    """People whose decision stands."""
    sole_reviewer_id: Mapped[uuid.UUID | None] = mapped_column(ForeignKey("accounts.id"))
    """Who decided, while it is one person."""
    needs_second: Mapped[bool] = mapped_column(default=False)
    """Whether a second person is to decide without seeing the first one's decision."""
    created_at: Mapped[datetime] = mapped_column(default=utc_now)
