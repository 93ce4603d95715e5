"""Server-sent events of jobs: what changed, as it changes, and where to go on after a lost connection."""

from __future__ import annotations

import asyncio
import time
from collections.abc import AsyncIterator, Callable
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from typing import Protocol
from uuid import UUID

from sqlalchemy import or_, select
from starlette.concurrency import run_in_threadpool

from server.database import Database, utc_now
from server.jobs import service
from server.jobs.describe import describe_job, describe_jobs
from server.jobs.models import ENDED_STATES, JobLogRow, JobRow
from server.jobs.schemas import JobLogLine, JobOut

POLL_SECONDS = 0.25
HEARTBEAT_SECONDS = 15.0
RETRY_MILLISECONDS = 2000

RECENT_JOBS = 200
"""Of the jobs that have ended, a new listener to all hears of the newest only."""

OVERLAP = timedelta(seconds=20)
"""Clocks of several machines may differ, and transactions end later than their time says: look back this far."""

HEADERS = {"Cache-Control": "no-cache", "X-Accel-Buffering": "no"}

StopFlag = Callable[[], bool]


class Feed(Protocol):
    """What a listener is sent; `server/live/feed.py` has another one."""

    has_ended: bool

    def is_quiet(self) -> bool:
        """Whether a poll would find nothing, as far as is known without a query."""
        ...

    def poll(self, database: Database) -> list[str]:
        """The events since the last time."""
        ...

    def close(self) -> None:
        """The listener has gone."""
        ...


def encode_event(event: str, data: str, event_id: str) -> str:
    """One event of the stream; its data is JSON."""
    return f"event: {event}\nid: {event_id}\ndata: {data}\n\n"


def log_line(row: JobLogRow) -> JobLogLine:
    return JobLogLine.model_validate({"n": row.number, "time": row.time, "level": row.level, "text": row.text})


@dataclass
class JobFeed:
    """Changes of one job. An id is `<version>.<log line>`: the last of each that the listener has."""

    job_id: UUID
    version: int = 0
    line: int = 0
    has_ended: bool = False

    @classmethod
    def after(cls, job_id: UUID, last_event_id: str | None) -> JobFeed:
        """Go on after the event whose id the listener had last; from the beginning when it makes no sense."""
        version, _, line = (last_event_id or "").partition(".")
        if version.isdecimal() and line.isdecimal() and len(version) + len(line) < 30:
            return cls(job_id, int(version), int(line))
        return cls(job_id)

    def close(self) -> None:
        """Nothing is held."""

    def is_quiet(self) -> bool:
        return False

    def poll(self, database: Database) -> list[str]:
        events = []
        with database.reading() as session:
            job = session.get(JobRow, self.job_id)
            lines = service.read_log(session, self.job_id, self.line)
            described = None if job is None or job.version == self.version else describe_job(session, job)
        if job is None:
            self.has_ended = True
            return []
        for row in lines:
            self.line = row.number
            events.append(encode_event("log", log_line(row).model_dump_json(), f"{self.version}.{self.line}"))
        if described is not None:
            self.version = job.version
            events.append(encode_event("job", described.model_dump_json(), f"{self.version}.{self.line}"))
        self.has_ended = job.state in ENDED_STATES and len(lines) < service.LOG_PAGE
        return events


@dataclass
class AllJobsFeed:
    """Changes of all jobs. An id is the time up to which the listener has heard."""

    since: datetime | None = None
    versions: dict[UUID, int] = field(default_factory=dict)
    has_ended: bool = False

    @classmethod
    def after(cls, last_event_id: str | None) -> AllJobsFeed:
        try:
            since = datetime.fromisoformat(last_event_id or "")
        except ValueError:
            return cls()
        return cls(since) if since.tzinfo is not None else cls()

    def close(self) -> None:
        """Nothing is held."""

    def is_quiet(self) -> bool:
        return False

    def poll(self, database: Database) -> list[str]:
        events = []
        for job in self.find_changes(database):
            assert self.since is not None
            events.append(encode_event("job", job.model_dump_json(), self.since.isoformat()))
        return events

    def find_changes(self, database: Database) -> list[JobOut]:
        """Jobs that changed since the last time, the oldest change first."""
        query = select(JobRow).order_by(JobRow.updated_at.desc())
        if self.since is not None:
            query = query.where(JobRow.updated_at > self.since - OVERLAP)
        else:
            recent = select(JobRow.id).order_by(JobRow.created_at.desc()).limit(RECENT_JOBS)
            query = query.where(or_(JobRow.state.not_in(ENDED_STATES), JobRow.id.in_(recent)))
        with database.reading() as session:
            changed = [job for job in session.scalars(query) if self.versions.get(job.id) != job.version]
            described = describe_jobs(session, changed)
        for job in reversed(changed):
            self.versions[job.id] = job.version
            self.since = max(job.updated_at, self.since or job.updated_at)
        self.since = self.since or utc_now()
        return described[::-1]


async def stream(feed: Feed, database: Database, is_stopping: StopFlag) -> AsyncIterator[str]:
    """The stream of a feed, until it has ended, the listener goes, or the server stops."""
    try:
        yield f"retry: {RETRY_MILLISECONDS}\n\n"
        spoken = time.monotonic()
        while not is_stopping():
            events = [] if feed.is_quiet() else await run_in_threadpool(feed.poll, database)
            if events:
                yield "".join(events)
                spoken = time.monotonic()
            if feed.has_ended:
                yield "event: end\ndata: {}\n\n"
                return
            if time.monotonic() - spoken > HEARTBEAT_SECONDS:
                spoken = time.monotonic()
                yield ": still here\n\n"
            await asyncio.sleep(POLL_SECONDS)
    finally:
        feed.close()
