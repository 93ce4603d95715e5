"""Worker processes: who is alive, and whose work has to be taken over."""

from __future__ import annotations

import os
import socket
from datetime import datetime, timedelta
from uuid import UUID

from sqlalchemy import CursorResult, func, select, update
from sqlalchemy.orm import Session

from server.database import UtcDateTime, utc_now
from server.jobs.models import WorkerRow

HEARTBEAT_SECONDS = 2.0

LOST_AFTER = timedelta(seconds=30)
"""Silence after which the others take a worker's jobs over."""

SHOWN_FOR = timedelta(hours=24)
"""How long a worker that ended stays in lists."""


def find_own_host(named: str | None) -> str:
    """Name of this machine among those with workers: the one that the settings give it, else its host name."""
    return named or socket.gethostname()


def find_database_time(session: Session) -> datetime:
    """Now, by the one clock that all machines share: PostgreSQL's own. SQLite is on this machine."""
    if session.get_bind().dialect.name == "sqlite":
        return utc_now()
    return session.scalars(select(func.clock_timestamp(type_=UtcDateTime))).one()


def register_worker(session: Session, slot: str, host: str | None = None) -> WorkerRow:
    """Note that this process has begun; earlier ones of the same slot are over, and DBOS gives this one their work."""
    ended = update(WorkerRow).where(WorkerRow.slot == slot, WorkerRow.recovered.is_(False))
    session.execute(ended.values(recovered=True))
    session.execute(update(WorkerRow).where(WorkerRow.slot == slot, WorkerRow.state == "running").values(state="lost"))
    worker = WorkerRow(slot=slot, pid=os.getpid(), host=find_own_host(host))
    worker.started_at = worker.last_seen_at = find_database_time(session)
    session.add(worker)
    session.flush()
    return worker


def beat(session: Session, worker_id: UUID) -> bool:
    """Note that this process is alive; False when the others have given it up."""
    statement = update(WorkerRow).where(WorkerRow.id == worker_id, WorkerRow.state == "running")
    result = session.execute(statement.values(last_seen_at=find_database_time(session)))
    assert isinstance(result, CursorResult)
    return result.rowcount == 1


def stop_worker(session: Session, worker_id: UUID) -> None:
    """Note that this process ends on purpose."""
    statement = update(WorkerRow).where(WorkerRow.id == worker_id, WorkerRow.state == "running")
    session.execute(statement.values(state="stopped", last_seen_at=find_database_time(session)))


def find_abandoned_workers(session: Session) -> list[WorkerRow]:
    """Workers that ended, or fell silent and are now given up, whose work nobody has taken over yet."""
    oldest = find_database_time(session) - LOST_AFTER
    silent = update(WorkerRow).where(WorkerRow.state == "running", WorkerRow.last_seen_at < oldest)
    session.execute(silent.values(state="lost"))
    alive = select(WorkerRow.slot).where(WorkerRow.state == "running")
    query = select(WorkerRow).where(
        WorkerRow.state != "running", WorkerRow.recovered.is_(False), WorkerRow.slot.not_in(alive)
    )
    return list(session.scalars(query))


def list_workers(session: Session) -> list[WorkerRow]:
    """Workers seen within the last day, the newest first."""
    query = select(WorkerRow).where(WorkerRow.last_seen_at > find_database_time(session) - SHOWN_FOR)
    return list(session.scalars(query.order_by(WorkerRow.started_at.desc()).limit(50)))


def is_alive(worker: WorkerRow, now: datetime) -> bool:
    """Whether it was heard of lately.

    Args:
        worker: Whose.
        now: As `find_database_time` tells it.
    """
    return worker.state == "running" and worker.last_seen_at > now - LOST_AFTER
