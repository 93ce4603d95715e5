"""`/jobs` and `/workers`."""

from __future__ import annotations

import uuid
from typing import Annotated, Any

from fastapi import APIRouter, Header, Query, Request, Response
from fastapi.responses import StreamingResponse
from sqlalchemy import select
from sqlalchemy.orm import Session

from server.access.audit import record_act
from server.access.service import ReviewerAccount
from server.database import DatabaseDep, SessionDep
from server.database.paging import Cursor, Limit, Page
from server.errors import StudioError, error_responses
from server.jobs import batches, create_jobs, events, restarting, service, workers
from server.jobs.batch_schemas import BatchCheck, BatchCreate, BatchMade, BatchOut, BulkAct, BulkDone, BulkRefusal
from server.jobs.calibrating import KIND as CALIBRATE
from server.jobs.calibrating import follow_job
from server.jobs.create_schemas import AnyJobCreate
from server.jobs.describe import describe_job, describe_jobs
from server.jobs.form import track_form
from server.jobs.job_kinds import find_obstacles, start_job
from server.jobs.models import ENDED_STATES, JobRow, WorkerRow
from server.jobs.obstacles import (
    make_check,
    refuse_at,
)
from server.jobs.schemas import JobCheck, JobKind, JobLog, JobOut, JobState, RestartCheck, WorkerOut
from server.jobs.track_schemas import JobForm
from server.storage import Storage, StorageDep

router = APIRouter(tags=["jobs"], responses=error_responses())

EVENT_STREAM: dict[int | str, dict[str, Any]] = {
    200: {"content": {"text/event-stream": {}}, "description": "Server-sent events."}
}


@router.post("/jobs", status_code=201, responses=error_responses(404))
def create_job(body: AnyJobCreate, session: SessionDep, storage: StorageDep, account: ReviewerAccount) -> JobOut:
    """Queue a job of the `kind` that the body names: `track` and `detect` a recording, `calibrate` cameras from films,
    `register` scans, `register_moving` a moving scan, `train` a hand model, or `loop`: register, choose, train
    and register again."""
    return describe_job(session, start_job(session, storage, body, account.id))


@router.post("/jobs/check", responses=error_responses(404))
def check_job(body: AnyJobCreate, session: SessionDep, storage: StorageDep, account: ReviewerAccount) -> JobCheck:
    """Whether such a job can be started, and why not. Nothing is started."""
    return make_check(session, find_obstacles(session, storage, body))


@router.post("/jobs/batch/check")
def check_batch(body: BatchCreate, session: SessionDep, account: ReviewerAccount) -> BatchCheck:
    """Which of the recordings cannot be tracked with these options, and why. Nothing is started."""
    return BatchCheck(refused=batches.check_batch(session, body.sequence_ids, body.params)[1])


@router.post("/jobs/batch", status_code=201)
def create_batch(body: BatchCreate, session: SessionDep, account: ReviewerAccount) -> BatchMade:
    """Queue one job for each of several recordings: all or, when one of them cannot be, none (422 with `refused`)."""
    batch_id, jobs = batches.create_batch(session, body.kind, body.sequence_ids, body.params, account.id)
    record_act(session, account.id, "batch.start", "batch", batch_id, jobs=len(jobs))
    return BatchMade(batch=batches.get_batch(session, batch_id), jobs=describe_jobs(session, jobs))


@router.post("/jobs/bulk")
def act_on_jobs(body: BulkAct, session: SessionDep, storage: StorageDep, account: ReviewerAccount) -> BulkDone:
    """Cancel, retry or resume several jobs. Each by itself: `refused` says which could not be, and why."""
    done, refused = [], []
    for job_id in dict.fromkeys(body.job_ids):
        try:
            done.append(_act(session, storage, body.act, job_id, account.id))
        except StudioError as error:
            refused.append(BulkRefusal(id=job_id, detail=error.detail))
    return BulkDone(jobs=describe_jobs(session, done), refused=refused)


@router.get("/jobs")
def list_jobs(
    session: SessionDep,
    sequence_id: uuid.UUID | None = None,
    kind: JobKind | None = None,
    state: Annotated[list[JobState], Query(description="One or several.")] = [],  # noqa: B006 (FastAPI copies it)
    created_by: uuid.UUID | None = None,
    batch_id: uuid.UUID | None = None,
    moving_scan_id: uuid.UUID | None = None,
    search: Annotated[str | None, Query(max_length=200, description="Words of its title.")] = None,
    cursor: Cursor = None,
    limit: Limit = 100,
) -> Page[JobOut]:
    """Jobs, the newest first."""
    wanted = service.JobFilter(sequence_id, state, created_by, batch_id, search, kind, moving_scan_id)
    rows, next_cursor = service.list_jobs(session, wanted, cursor, limit)
    return Page(items=describe_jobs(session, rows), next_cursor=next_cursor)


@router.get("/jobs/batches")
def list_batches(session: SessionDep, cursor: Cursor = None, limit: Limit = 100) -> Page[BatchOut]:
    """Batches with the states of their jobs, the newest first."""
    items, next_cursor = batches.list_batches(session, cursor, limit)
    return Page(items=items, next_cursor=next_cursor)


@router.get("/jobs/batches/{batch_id}", responses=error_responses(404))
def get_batch(batch_id: uuid.UUID, session: SessionDep) -> BatchOut:
    """One batch with the states of its jobs."""
    return batches.get_batch(session, batch_id)


@router.get("/jobs/form")
def get_job_form(session: SessionDep) -> JobForm:
    """Options of a tracking job, and presets: options that go together."""
    return track_form(session)


@router.get("/jobs/events", response_class=StreamingResponse, responses=EVENT_STREAM)
def stream_all_jobs(
    request: Request, database: DatabaseDep, last_event_id: Annotated[str | None, Header()] = None
) -> StreamingResponse:
    """Every change of every job: `event: job` with a Job."""
    return answer_stream(request, database, events.AllJobsFeed.after(last_event_id))


@router.get("/jobs/{job_id}", responses=error_responses(404))
def get_job(job_id: uuid.UUID, session: SessionDep) -> JobOut:
    """One job."""
    return describe_job(session, service.get_job(session, job_id))


@router.get("/jobs/{job_id}/restart", responses=error_responses(404))
def check_restart(job_id: uuid.UUID, session: SessionDep, storage: StorageDep) -> RestartCheck:
    """Whether a job that ended without success can be resumed or tried again, and what is kept of it."""
    return restarting.check_restart(session, storage, service.get_job(session, job_id))


@router.post("/jobs/{job_id}/cancel", responses=error_responses(404, 409))
def cancel_job(job_id: uuid.UUID, session: SessionDep, storage: StorageDep, account: ReviewerAccount) -> JobOut:
    """End a job that is queued or running."""
    return describe_job(session, _act(session, storage, "cancel", job_id, account.id))


@router.post("/jobs/{job_id}/retry", status_code=201, responses=error_responses(404, 409))
def retry_job(job_id: uuid.UUID, session: SessionDep, storage: StorageDep, account: ReviewerAccount) -> JobOut:
    """A new job with the parameters of one that has ended."""
    return describe_job(session, _act(session, storage, "retry", job_id, account.id))


@router.post("/jobs/{job_id}/resume", responses=error_responses(404, 409))
def resume_job(job_id: uuid.UUID, session: SessionDep, storage: StorageDep, account: ReviewerAccount) -> JobOut:
    """Continue a cancelled or failed job where it stopped."""
    return describe_job(session, _act(session, storage, "resume", job_id, account.id))


def _act(session: Session, storage: Storage, act: str, job_id: uuid.UUID, account_id: uuid.UUID) -> JobRow:
    """Do one thing to one job, and note who did it."""
    asked = service.get_job(session, job_id)
    if act in restarting.ACTS and asked.state in ENDED_STATES:
        refuse_at(restarting.find_restart_obstacles(session, storage, asked))
    if act == "retry":
        job = service.retry_job(session, job_id, account_id)
        create_jobs.copy_job_scans(session, job_id, job.id)
        if job.kind == CALIBRATE:
            follow_job(session, job)
    else:
        job = service.cancel_job(session, job_id) if act == "cancel" else service.resume_job(session, job_id)
    record_act(session, account_id, f"job.{act}", "job", job_id)
    return job


@router.get("/jobs/{job_id}/log", responses=error_responses(404))
def get_job_log(job_id: uuid.UUID, session: SessionDep, after: Annotated[int, Query(ge=0)] = 0) -> JobLog:
    """Lines of a job's log after line `after`, at most a thousand."""
    service.get_job(session, job_id)
    return JobLog(lines=[events.log_line(row) for row in service.read_log(session, job_id, after)])


@router.get("/jobs/{job_id}/events", response_class=StreamingResponse, responses=EVENT_STREAM | error_responses(404))
def stream_job(
    job_id: uuid.UUID, request: Request, database: DatabaseDep, last_event_id: Annotated[str | None, Header()] = None
) -> Response:
    """Changes of one job: `event: job` with a Job, `event: log` with a line, `event: end` when there will be no more.

    204 tells an `EventSource` that reconnects to stop: it has heard everything.
    """
    feed = events.JobFeed.after(job_id, last_event_id)
    with database.reading() as session:
        job = service.get_job(session, job_id)
        is_over = job.state in service.ENDED_STATES and job.version == feed.version
        if is_over and not service.read_log(session, job_id, feed.line, limit=1):
            return Response(status_code=204)
    return answer_stream(request, database, feed)


@router.get("/workers")
def list_workers(session: SessionDep) -> Page[WorkerOut]:
    """Worker processes of the last day."""
    rows = workers.list_workers(session)
    query = select(JobRow.worker_id, JobRow.id).where(JobRow.state == "running", JobRow.worker_id.is_not(None))
    busy = {row.worker_id: row.id for row in session.execute(query)}
    now = workers.find_database_time(session)
    return Page(items=[_worker(row, workers.is_alive(row, now), busy.get(row.id)) for row in rows], next_cursor=None)


def _worker(row: WorkerRow, is_alive: bool, job_id: uuid.UUID | None) -> WorkerOut:
    state = "silent" if row.state == "running" and not is_alive else row.state
    return WorkerOut.model_validate(
        {
            "id": row.id,
            "name": row.slot,
            "host": row.host,
            "pid": row.pid,
            "state": state,
            "job_id": job_id,
            "started_at": row.started_at,
            "last_seen_at": row.last_seen_at,
        }
    )


def answer_stream(request: Request, database: DatabaseDep, feed: events.Feed) -> StreamingResponse:
    """The answer that streams a feed until the server stops."""

    def is_stopping() -> bool:
        return getattr(request.app.state, "is_stopping", False)

    body = events.stream(feed, database, is_stopping)
    return StreamingResponse(body, media_type="text/event-stream", headers=events.HEADERS)
