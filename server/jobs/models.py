"""Tables of jobs, their logs and the workers that run them."""

from __future__ import annotations

import uuid
from datetime import datetime
from typing import Any

from sqlalchemy import CheckConstraint, ForeignKey, Index, String, Text, UniqueConstraint
from sqlalchemy.orm import Mapped, mapped_column

from server.database import Base, utc_now
from server.hand_models.models import HandModelRow
from server.moving_scans.models import MovingScanRow
from server.scans.models import ScanRow
from server.sequences.models import SequenceRow
from server.tracks.models import TrackRow

ENDED_STATES = ("succeeded", "failed", "cancelled")
STATES = ("queued", "running", *ENDED_STATES)


class JobRow(Base):
    """One piece of long work, as people see it. The DBOS workflow `<id>:<attempt>` does it."""

    __tablename__ = "jobs"
    __table_args__ = (
        Index(None, "created_at", "id"),
        Index(None, "state"),
        Index(None, "sequence_id"),
        Index(None, "updated_at"),
        Index(None, "batch_id"),
        Index(None, "moving_scan_id"),
        CheckConstraint("state IN ('queued', 'running', 'succeeded', 'failed', 'cancelled')", name="state"),
    )

    kind: Mapped[str] = mapped_column(String(20))
    state: Mapped[str] = mapped_column(String(10), default="queued")
    sequence_id: Mapped[uuid.UUID | None] = mapped_column(ForeignKey(SequenceRow.id))
    """Of a job that tracks or detects."""
    moving_scan_id: Mapped[uuid.UUID | None] = mapped_column(ForeignKey(MovingScanRow.id))
    """Of a job that registers one."""
    track_id: Mapped[uuid.UUID | None] = mapped_column(ForeignKey(TrackRow.id))
    """What a tracking job produced."""
    hand_model_id: Mapped[uuid.UUID | None] = mapped_column(ForeignKey(HandModelRow.id))
    """What training produced, the last one of a loop."""
    title: Mapped[str] = mapped_column(String(300), default="")
    """What it is about, when that is no recording."""
    params: Mapped[dict[str, Any]]
    progress: Mapped[float] = mapped_column(default=0.0)
    stage: Mapped[str] = mapped_column(String(200), default="queued")
    frames_done: Mapped[int] = mapped_column(default=0)
    frames_total: Mapped[int] = mapped_column(default=0)
    seconds_left: Mapped[float | None]
    error: Mapped[str | None] = mapped_column(Text)
    attempt: Mapped[int] = mapped_column(default=1)
    """Counts starts that somebody asked for: 1, then one more for every resume."""
    dispatched_attempt: Mapped[int] = mapped_column(default=0)
    """The attempt that a worker has put into the queue of DBOS; 0 for none."""
    worker_id: Mapped[uuid.UUID | None]
    """The worker that runs it. Whoever else still holds it in memory must let go."""
    crashes: Mapped[int] = mapped_column(default=0)
    """Workers lost in a row without a chunk finished in between."""
    version: Mapped[int] = mapped_column(default=1)
    """Grows with every change of the row; the number of its events."""
    retry_of: Mapped[uuid.UUID | None]
    batch_id: Mapped[uuid.UUID | None]
    """Shared by the jobs that one request started."""
    created_by: Mapped[uuid.UUID | None] = mapped_column(ForeignKey("accounts.id"))
    created_at: Mapped[datetime] = mapped_column(default=utc_now)
    updated_at: Mapped[datetime] = mapped_column(default=utc_now)
    started_at: Mapped[datetime | None]
    ended_at: Mapped[datetime | None]


class JobScanRow(Base):
    """A scan that a job is to register, as chosen when the job was made; `number` counts from 0."""

    __tablename__ = "job_scans"
    __table_args__ = (UniqueConstraint("job_id", "number"),)

    job_id: Mapped[uuid.UUID] = mapped_column(ForeignKey("jobs.id"))
    number: Mapped[int]
    scan_id: Mapped[uuid.UUID] = mapped_column(ForeignKey(ScanRow.id))


class JobLogRow(Base):
    """One line of a job's log; `number` counts from 1 within the job."""

    __tablename__ = "job_log_lines"
    __table_args__ = (UniqueConstraint("job_id", "number"),)

    job_id: Mapped[uuid.UUID] = mapped_column(ForeignKey("jobs.id"))
    number: Mapped[int]
    time: Mapped[datetime] = mapped_column(default=utc_now)
    level: Mapped[str] = mapped_column(String(10))
    text: Mapped[str] = mapped_column(Text)


class WorkerRow(Base):
    """One worker process, from its start to its end. It shares the name `slot` with its predecessors and successors."""

    __tablename__ = "workers"
    __table_args__ = (
        Index(None, "state"),
        CheckConstraint("state IN ('running', 'stopped', 'lost')", name="state"),
    )

    slot: Mapped[str] = mapped_column(String(200))
    pid: Mapped[int]
    host: Mapped[str] = mapped_column(String(200))
    state: Mapped[str] = mapped_column(String(10), default="running")
    """`running`; `stopped` when it said so; `lost` when it was not seen for too long or was replaced."""
    recovered: Mapped[bool] = mapped_column(default=False)
    """Whether its unfinished work has been given back to the queue after it ended."""
    started_at: Mapped[datetime] = mapped_column(default=utc_now)
    last_seen_at: Mapped[datetime] = mapped_column(default=utc_now)
