"""The DBOS workflow of a tracking job. Only the worker process imports this: DBOS takes a second to load."""

from __future__ import annotations

import json
import logging
import traceback
import uuid
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any
from uuid import UUID

from dbos import DBOS
from sqlalchemy.orm import Session

from server.annotations.service import export_annotations
from server.database import Database, utc_now
from server.errors import StudioError
from server.jobs import service
from server.jobs.files import JobFiles
from server.jobs.progress import JobProgress, JobStoppedError
from server.jobs.tracking import TrackingJob
from server.storage import Storage
from server.tracks.service import add_track

log = logging.getLogger(__name__)

QUEUE = "jobs"
APPLICATION = "handloom"
APPLICATION_VERSION = "2"
"""Of the steps and their files. A job begun under one version is only continued by workers of that version."""

MAX_CRASHES = 3
"""Workers a job may lose in a row, without finishing a chunk, before it is taken to be their killer."""

TRACK_NAMESPACE = UUID("7a1d4c53-3a0f-4f0e-9a52-6f1d0c9b8e21")

Workflow = Callable[[str, int], str]


@dataclass(frozen=True)
class WorkerContext:
    """What the workflow needs of the process it runs in."""

    database: Database
    storage: Storage
    worker_id: UUID


def workflow_id(job_id: UUID, attempt: int) -> str:
    """Name of the workflow that does one attempt of a job."""
    return f"{job_id}:{attempt}"


def register_workflow(context: WorkerContext) -> Workflow:
    """Make the workflow `track` known to DBOS, before it is launched."""

    @DBOS.step(name="snapshot")
    def snapshot(job_id: str) -> dict[str, Any]:
        return _Run(context, UUID(job_id)).snapshot()

    @DBOS.step(name="start")
    def start(job_id: str, attempt: int) -> dict[str, Any]:
        run = _Run(context, UUID(job_id))
        return run.job.start(run.progress(attempt))

    @DBOS.step(name="chunk")
    def chunk(job_id: str, attempt: int, begun: dict[str, Any], number: int) -> dict[str, Any]:
        run = _Run(context, UUID(job_id))
        return run.job.track_chunk(begun, number, run.progress(attempt))

    @DBOS.step(name="finish")
    def finish(job_id: str, attempt: int, begun: dict[str, Any]) -> str:
        return str(_Run(context, UUID(job_id)).finish(attempt, begun))

    @DBOS.workflow(name="track", max_recovery_attempts=1000)
    def track(job_id: str, attempt: int) -> str:
        run = _Run(context, UUID(job_id))
        try:
            if not run.claim(attempt):
                run.clean_up()
                return "not wanted"
            run.files.check(snapshot(job_id)["files"])
            begun = start(job_id, attempt)
            run.files.check(begun["files"])
            for number in range(len(begun["chunks"])):
                run.files.check(chunk(job_id, attempt, begun, number)["files"])
            finish(job_id, attempt, begun)
        except JobStoppedError:
            log.info("job %s stopped", job_id)
            return "stopped"
        except Exception as error:
            run.fail(attempt, error)
            return "failed"
        run.files.remove()
        return "succeeded"

    return track


class _Run:
    """One job in this worker."""

    def __init__(self, context: WorkerContext, job_id: UUID) -> None:
        self._context, self._job_id = context, job_id
        with context.database.reading() as session:
            self._row = service.get_job(session, job_id)
        storage = context.storage
        self.files = JobFiles(storage.folder("jobs", job_id), storage.remote_folder("jobs", job_id))

    @property
    def _sequence_id(self) -> UUID:
        assert self._row.sequence_id is not None, "a tracking job has a recording"
        return self._row.sequence_id

    @property
    def job(self) -> TrackingJob:
        recording = self._context.storage.refresh("sequences", self._sequence_id)
        return TrackingJob(recording, self._row.params, self.files)

    def progress(self, attempt: int) -> JobProgress:
        return JobProgress(self._context.database, self._job_id, attempt, self._context.worker_id)

    def claim(self, attempt: int) -> bool:
        """Take the job; fail it when it has cost too many workers."""
        with self._context.database.writing() as session:
            claimed = service.claim_job(session, self._job_id, attempt, self._context.worker_id)
            crashes = 0 if claimed is None else claimed.crashes
        if crashes > MAX_CRASHES:
            raise StudioError(
                f"The worker process ended {crashes} times while it did the same frames, by a crash or for want of "
                "memory. The log of the worker says more; `resume` tries once again."
            )
        return claimed is not None

    def clean_up(self) -> None:
        """Remove the working files of a job that is done: whoever ended it may have died before that."""
        if self._row.state == "succeeded":
            self.files.remove()

    def snapshot(self) -> dict[str, Any]:
        """Keep the annotations as they are now: doing a step again must not see later ones."""
        kept = self.files.read_manifest("snapshot")
        if kept is not None:
            return kept
        with self._context.database.reading() as session:
            document = export_annotations(session, self._sequence_id)
        self.files.write(self.files.annotations, lambda path: path.write_text(json.dumps(document)))
        return self.files.write_manifest("snapshot", [self.files.annotations], {})

    def finish(self, attempt: int, begun: dict[str, Any]) -> UUID:
        """Store the track and its row, and end the job, in one transaction."""
        track_id = uuid.uuid5(TRACK_NAMESPACE, str(self._job_id))
        folder = self._context.storage.folder("tracks", track_id)
        self.job.finish(begun, folder, self.progress(attempt))
        self._context.storage.publish("tracks", track_id)
        with self._context.database.writing() as session:
            add_track(session, folder, track_id, self._sequence_id, self._job_id)
            self._end(session, attempt, "succeeded", track_id=track_id, progress=1.0, frames_done=begun["frames"])
        return track_id

    def fail(self, attempt: int, error: Exception) -> None:
        """End the job with what went wrong, in words for people; the traceback goes to its log."""
        message = describe_error(error)
        log.error("job %s failed: %s", self._job_id, message, exc_info=error)
        with self._context.database.writing() as session:
            if self._end(session, attempt, "failed", error=message):
                service.append_log(session, self._job_id, "error", message)
                service.append_log(session, self._job_id, "debug", "".join(traceback.format_exception(error)))

    def _end(self, session: Session, attempt: int, state: str, **values: Any) -> bool:
        values = {"state": state, "stage": state, "ended_at": utc_now(), "seconds_left": None, **values}
        ended = service.update_running(session, self._job_id, attempt, self._context.worker_id, **values)
        if ended and state == "succeeded":
            service.append_log(session, self._job_id, "info", "done")
        return ended


def describe_error(error: Exception) -> str:
    """What went wrong, for people. An error that nobody foresaw is named as such."""
    from tracker import TrackerError

    if isinstance(error, (StudioError, TrackerError)):
        return str(error)
    return f"An unforeseen error, {type(error).__name__}: {error}. The job's log has the details; please report it."
