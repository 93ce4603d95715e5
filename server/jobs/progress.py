"""How a running job tells people where it is, and how it learns that it should stop."""

from __future__ import annotations

import logging
import os
import time
from typing import Any
from uuid import UUID

from sqlalchemy import case
from sqlalchemy.exc import OperationalError

from server.database import Database
from server.jobs import service
from server.jobs.models import JobRow
from server.jobs.pace import Pace

log = logging.getLogger(__name__)

PUBLISH_SECONDS = 0.2
"""Between two updates of the row; also how soon a cancelled job notices."""

TRACKING_ENDS = 0.98
"""Share of the progress bar after the last frame."""

LOST_OWNERSHIP_EXIT = 75


class JobStoppedError(Exception):
    """Somebody cancelled the job, or started it anew: leave it alone."""


class JobProgress:
    """Publishes one attempt of a job on behalf of the worker that holds it; a part of it, which has none, beside it."""

    def __init__(self, database: Database, job_id: UUID, attempt: int, worker_id: UUID | None, pace: Pace) -> None:
        self._database, self._job_id, self._attempt, self._worker_id = database, job_id, attempt, worker_id
        self._published = 0.0
        self._last_stage = ""
        self._pace = pace

    def finishing(self, name: str) -> None:
        """Name what is being done after the tracking."""
        self._publish_stage(name, TRACKING_ENDS)

    def frames(self, done: int, total: int, begins: float, stage: str = "tracking") -> None:
        """Say that `done` of `total` frames are done; `begins` is the share of the bar at the first of them."""
        self._publish_frames(done, total, begins, at_once=False, stage=stage)

    def chunk_done(self, done: int, total: int, begins: float, message: str, stage: str = "tracking") -> None:
        """Say that the frames so far are safe on disk."""
        self.log("info", message)
        self._publish_frames(done, total, begins, at_once=True, stage=stage, crashes=0)

    def part(self, span: tuple[float, float], name: str, share: float) -> None:
        """Name what is being done in one part of the bar, and how much of it is done, 0 to 1."""
        first, last = span
        self._publish_stage(name, first + (last - first) * min(max(share, 0.0), 1.0))

    def frame_done(self, total: int, begins: float) -> None:
        """Say that one frame more is safe on disk, while others may be made elsewhere."""
        with self._database.reading() as session:
            before = service.get_job(session, self._job_id).frames_done
        done = case((JobRow.frames_done < total, JobRow.frames_done + 1), else_=total)
        share = begins + (TRACKING_ENDS - begins) * min(before + 1, total) / total
        self._publish(True, progress=share, frames_done=done, frames_total=total, crashes=0)

    def check(self) -> None:
        """Raise if the job is to stop."""
        self._publish(True)

    def kept(self) -> None:
        """Say that what was done so far is safe on disk."""
        self._publish(True, crashes=0)

    def scans(self, done: int, total: int, span: tuple[float, float], name: str, share: float) -> None:
        """Say that `done` of `total` scans are registered, and a share of the next; also how a job learns to stop."""
        self._publish(False, **self._describe_scans(done + share, total, span), stage=name, frames_done=done)

    def scans_done(self, done: int, total: int, span: tuple[float, float]) -> None:
        """Say that another scan is safe on disk."""
        self._publish(True, **self._describe_scans(done, total, span), frames_done=done, crashes=0)

    def _describe_scans(self, done: float, total: int, span: tuple[float, float]) -> dict[str, Any]:
        first, last = span
        return {"progress": first + (last - first) * done / max(total, 1), "frames_total": total}

    def log(self, level: str, text: str) -> None:
        """Add a line to the job's log."""
        with self._database.writing() as session:
            service.append_log(session, self._job_id, level, text)

    def _publish_stage(self, name: str, progress: float) -> None:
        changed, self._last_stage = name != self._last_stage, name
        if changed:
            self.log("info", name)
        self._publish(changed, stage=name, progress=progress)

    def _publish_frames(self, done: int, total: int, begins: float, *, at_once: bool, **values: object) -> None:
        share = begins + (TRACKING_ENDS - begins) * done / max(total, 1)
        self._publish(at_once, progress=share, frames_done=done, frames_total=total, **values)

    def _publish(self, at_once: bool, progress: float | None = None, **values: object) -> None:
        now = time.monotonic()
        if not at_once and now - self._published < PUBLISH_SECONDS:
            return
        self._published = now
        if progress is not None:
            values |= {"progress": progress, "seconds_left": self._pace.estimate(progress)}
        try:
            with self._database.writing() as session:
                owned = service.update_running(session, self._job_id, self._attempt, self._worker_id, **values)
                job = None if owned else session.get(JobRow, self._job_id)
        except OperationalError as error:
            log.warning("progress of job %s not published: %s", self._job_id, error)
            return
        if not owned:
            self._let_go(job)

    def _let_go(self, job: JobRow | None) -> None:
        is_held = job is not None and job.state == "running" and job.attempt == self._attempt
        if is_held and self._worker_id is not None:
            # This process slept so long that another worker took its work over. What it still has in memory must not be
            # recorded beside the other's: end like a crash, which every step survives.
            log.error("job %s was taken over by another worker; this one ends", self._job_id)
            os._exit(LOST_OWNERSHIP_EXIT)
        raise JobStoppedError("The job was cancelled.")
