"""One job in this worker: taken, done, ended. What is done in between is each kind's own."""

from __future__ import annotations

import logging
import uuid
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any
from uuid import UUID

from sqlalchemy.orm import Session

from server.database import Database, utc_now
from server.errors import StudioError
from server.jobs import service
from server.jobs.failure import describe_error
from server.jobs.files import JobFiles
from server.jobs.pace import Paces
from server.jobs.progress import JobProgress, JobStoppedError
from server.storage import Storage

log = logging.getLogger(__name__)

MAX_CRASHES = 3
"""Workers a job may lose in a row, without finishing a step, before it is taken to be their killer."""


@dataclass(frozen=True)
class WorkerContext:
    """What workflows need of the process they run in."""

    database: Database
    storage: Storage
    worker_id: UUID
    on_track: Callable[[UUID], None] = lambda track_id: None
    """Told the id of a track that a job has stored."""
    paces: Paces = field(default_factory=Paces)


class JobRun:
    """One job in this worker."""

    def __init__(self, context: WorkerContext, job_id: UUID) -> None:
        self.context, self.job_id = context, job_id
        self.worker_id: UUID | None = context.worker_id
        with context.database.reading() as session:
            self.row = service.get_job(session, job_id)
        storage = context.storage
        self.files = JobFiles(storage.folder("jobs", job_id), storage.remote_folder("jobs", job_id))

    def progress(self, attempt: int) -> JobProgress:
        pace = self.context.paces.find(self.job_id, attempt)
        return JobProgress(self.context.database, self.job_id, attempt, self.worker_id, pace)

    def attempt(self, number: int, work: Callable[[], None]) -> str:
        """Take the job and do it; whatever happens, say how it ended."""

        def take_and_do() -> str:
            if not self._claim(number):
                if self.row.state == "succeeded":  # whoever ended it may have died before that
                    self.files.remove()
                return "not wanted"
            work()
            self.files.remove()
            return "succeeded"

        return self._settle(number, take_and_do)

    def part(self, number: int, work: Callable[[], None]) -> str:
        """Do a part of a job that another worker may hold; a part that fails ends the job."""
        self.worker_id = None

        def do() -> str:
            if (self.row.state, self.row.attempt) != ("running", number):
                return "not wanted"
            work()
            return "succeeded"

        return self._settle(number, do)

    def _settle(self, number: int, do: Callable[[], str]) -> str:
        try:
            return do()
        except JobStoppedError:
            log.info("job %s stopped", self.job_id)
            return "stopped"
        except Exception as error:
            self._fail(number, error)
            return "failed"

    def end(self, session: Session, attempt: int, state: str, **values: Any) -> bool:
        """End the job in the transaction that stores what it made."""
        values = {"state": state, "stage": state, "ended_at": utc_now(), "seconds_left": None, **values}
        ended = service.update_running(session, self.job_id, attempt, self.worker_id, **values)
        if ended and state == "succeeded":
            service.append_log(session, self.job_id, "info", "done")
        return ended

    def _claim(self, attempt: int) -> bool:
        """Take the job; fail it when it has cost too many workers."""
        with self.context.database.writing() as session:
            claimed = service.claim_job(session, self.job_id, attempt, self.context.worker_id)
            crashes = 0 if claimed is None else claimed.crashes
        if crashes > MAX_CRASHES:
            raise StudioError(
                f"The worker process ended {crashes} times while it did the same step, by a crash or for want of "
                "memory. The log of the worker says more; `resume` tries once again."
            )
        return claimed is not None

    def _fail(self, attempt: int, error: Exception) -> None:
        """End the job with what went wrong, in words for people; the traceback goes to the log of this process."""
        number = uuid.uuid4().hex[:8]
        log.error("job %s failed, error %s", self.job_id, number, exc_info=error)
        message = describe_error(error, number, self.context.storage.root)
        with self.context.database.writing() as session:
            if self.end(session, attempt, "failed", error=message):
                service.append_log(session, self.job_id, "error", message)
