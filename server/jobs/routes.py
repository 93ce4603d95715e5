"""`/jobs` and `/workers`."""

from __future__ import annotations

import uuid
from typing import Annotated, Any

from fastapi import APIRouter, Header, Query, Request, Response
from fastapi.responses import StreamingResponse
from sqlalchemy import select

from server.database import DatabaseDep, SessionDep
from server.database.paging import Cursor, Limit, Page
from server.errors import error_responses
from server.jobs import events, service, workers
from server.jobs.form import track_form
from server.jobs.models import JobRow, WorkerRow
from server.jobs.schemas import JobCreate, JobForm, JobLog, JobOut, JobState, WorkerOut

router = APIRouter(tags=["jobs"], responses=error_responses())

EVENT_STREAM: dict[int | str, dict[str, Any]] = {
    200: {"content": {"text/event-stream": {}}, "description": "Server-sent events."}
}


@router.post("/jobs", status_code=201, responses=error_responses(404))
def create_job(body: JobCreate, session: SessionDep) -> JobOut:
    """Queue a job."""
    params = service.check_track_params(session, body.sequence_id, body.params)
    return JobOut.model_validate(service.create_job(session, body.kind, body.sequence_id, params))


@router.get("/jobs")
def list_jobs(
    session: SessionDep,
    sequence_id: uuid.UUID | None = None,
    state: JobState | None = None,
    cursor: Cursor = None,
    limit: Limit = 100,
) -> Page[JobOut]:
    """Jobs, the newest first."""
    rows, next_cursor = service.list_jobs(session, sequence_id, state, cursor, limit)
    return Page(items=[JobOut.model_validate(row) for row in rows], next_cursor=next_cursor)


@router.get("/jobs/form")
def get_job_form() -> JobForm:
    """Options of a tracking job, and presets: options that go together."""
    return track_form()


@router.get("/jobs/events", response_class=StreamingResponse, responses=EVENT_STREAM)
def stream_all_jobs(
    request: Request, database: DatabaseDep, last_event_id: Annotated[str | None, Header()] = None
) -> StreamingResponse:
    """Every change of every job: `event: job` with a Job."""
    return _stream(request, database, events.AllJobsFeed.after(last_event_id))


@router.get("/jobs/{job_id}", responses=error_responses(404))
def get_job(job_id: uuid.UUID, session: SessionDep) -> JobOut:
    """One job."""
    return JobOut.model_validate(service.get_job(session, job_id))


@router.post("/jobs/{job_id}/cancel", responses=error_responses(404, 409))
def cancel_job(job_id: uuid.UUID, session: SessionDep) -> JobOut:
    """End a job that is queued or running."""
    service.get_job(session, job_id)
    return JobOut.model_validate(service.cancel_job(session, job_id))


@router.post("/jobs/{job_id}/retry", status_code=201, responses=error_responses(404, 409))
def retry_job(job_id: uuid.UUID, session: SessionDep) -> JobOut:
    """A new job with the parameters of one that has ended."""
    return JobOut.model_validate(service.retry_job(session, job_id))


@router.post("/jobs/{job_id}/resume", responses=error_responses(404, 409))
def resume_job(job_id: uuid.UUID, session: SessionDep) -> JobOut:
    """Go on with a cancelled or failed job where it stopped."""
    service.get_job(session, job_id)
    return JobOut.model_validate(service.resume_job(session, job_id))


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
    return _stream(request, database, feed)


@router.get("/workers")
def list_workers(session: SessionDep) -> Page[WorkerOut]:
    """Worker processes of the last day."""
    rows = workers.list_workers(session)
    query = select(JobRow.worker_id, JobRow.id).where(JobRow.state == "running", JobRow.worker_id.is_not(None))
    busy = {row.worker_id: row.id for row in session.execute(query)}
    return Page(items=[_worker(row, busy.get(row.id)) for row in rows], next_cursor=None)


def _worker(row: WorkerRow, job_id: uuid.UUID | None) -> WorkerOut:
    state = "silent" if row.state == "running" and not workers.is_alive(row) else row.state
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


def _stream(request: Request, database: DatabaseDep, feed: events.JobFeed | events.AllJobsFeed) -> StreamingResponse:
    def is_stopping() -> bool:
        return getattr(request.app.state, "is_stopping", False)

    body = events.stream(feed, database, is_stopping)
    return StreamingResponse(body, media_type="text/event-stream", headers=events.HEADERS)
