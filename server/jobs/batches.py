"""Batches: jobs that one request started. A batch has no row of its own; it is what its jobs have in common."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Any
from uuid import UUID, uuid4

from sqlalchemy import func, select
from sqlalchemy.orm import Session, aliased

from server.access.service import find_names
from server.database.paging import fetch_page
from server.errors import InvalidError, NotFoundError, StudioError
from server.jobs import service
from server.jobs.batch_schemas import BatchOut, BulkRefusal
from server.jobs.models import ENDED_STATES, STATES, JobRow


class RefusedBatchError(InvalidError):
    """Some of a batch cannot be started, so nothing of it was."""


def create_batch(
    session: Session, kind: str, sequence_ids: Sequence[UUID], params: dict[str, Any], account_id: UUID
) -> tuple[UUID, list[JobRow]]:
    """Queue one job for each recording, or none at all when one of them cannot be."""
    checked, refused = check_batch(session, sequence_ids, params)
    if refused:
        raise RefusedBatchError(
            f"{len(refused)} of {len(refused) + len(checked)} recordings cannot be tracked with these options; "
            f"no job was started. The first: {refused[0].detail} Leave them out or change the options.",
            refused=[item.model_dump(mode="json") for item in refused],
        )
    batch_id = uuid4()
    jobs = [
        service.create_job(session, kind, sequence_id, options, created_by=account_id, batch_id=batch_id)
        for sequence_id, options in checked
    ]
    return batch_id, jobs


def check_batch(
    session: Session, sequence_ids: Sequence[UUID], params: dict[str, Any]
) -> tuple[list[tuple[UUID, dict[str, Any]]], list[BulkRefusal]]:
    """Recordings that can be tracked so with their options in full, and those that cannot."""
    from tracker import TrackerError

    checked, refused = [], []
    for sequence_id in dict.fromkeys(sequence_ids):
        try:
            checked.append((sequence_id, service.check_track_params(session, sequence_id, params)))
        except (StudioError, TrackerError) as error:
            refused.append(BulkRefusal(id=sequence_id, detail=str(error)))
    return checked, refused


def get_batch(session: Session, batch_id: UUID) -> BatchOut:
    """What has become of a batch."""
    found = _summarize(session, [batch_id])
    if not found:
        raise NotFoundError(f"There is no batch {batch_id}.")
    return found[0]


def list_batches(session: Session, cursor: str | None, limit: int) -> tuple[list[BatchOut], str | None]:
    """Newest first."""
    began = func.min(JobRow.created_at)
    query = select(JobRow.batch_id).where(JobRow.batch_id.is_not(None)).group_by(JobRow.batch_id)
    ids, next_cursor = fetch_page(session, query, (began, JobRow.batch_id), cursor, limit)
    return _summarize(session, ids), next_cursor


def _summarize(session: Session, batch_ids: Sequence[UUID]) -> list[BatchOut]:
    """In the order of the ids. A job that was tried again counts no more: the later one stands for it."""
    later = aliased(JobRow)
    is_replaced = select(later.id).where(later.retry_of == JobRow.id, later.batch_id == JobRow.batch_id).exists()
    query = select(JobRow).where(JobRow.batch_id.in_(batch_ids), ~is_replaced).order_by(JobRow.created_at, JobRow.id)
    jobs: dict[UUID, list[JobRow]] = {id_: [] for id_ in batch_ids}
    for job in session.scalars(query) if batch_ids else ():
        assert job.batch_id is not None
        jobs[job.batch_id].append(job)
    names = find_names(session, (group[0].created_by for group in jobs.values() if group))
    return [_describe(batch_id, group, names) for batch_id, group in jobs.items() if group]


def _describe(batch_id: UUID, jobs: list[JobRow], names: dict[UUID | None, str]) -> BatchOut:
    counts = Counter(job.state for job in jobs)
    ends = [job.ended_at for job in jobs if job.ended_at is not None]
    is_over = all(job.state in ENDED_STATES for job in jobs)
    return BatchOut(
        id=batch_id,
        kind=jobs[0].kind,
        params=jobs[0].params,
        created_at=min(job.created_at for job in jobs),
        created_by=jobs[0].created_by,
        created_by_name=names.get(jobs[0].created_by),
        ended_at=max(ends) if is_over and ends else None,
        total=len(jobs),
        states={state: counts[state] for state in STATES},
        progress=sum(1.0 if job.state in ENDED_STATES else job.progress for job in jobs) / len(jobs),
        seconds_left=None if is_over else _estimate_seconds_left(jobs),
    )


def _estimate_seconds_left(jobs: list[JobRow]) -> float | None:
    """What the running ones say, and for those that wait the time that a done one took; shared by those who run now.

    None until one of them is done or knows its own rest.
    """
    running = [job for job in jobs if job.state == "running"]
    took = [
        (job.ended_at - job.started_at).total_seconds()
        for job in jobs
        if job.state == "succeeded" and job.ended_at is not None and job.started_at is not None
    ]
    known = [job.seconds_left for job in running if job.seconds_left is not None]
    if not took and not known:
        return None
    usual = sum(took) / len(took) if took else max(known) / max(1.0 - _part_done(running), 0.05)
    rest = sum(usual if job.seconds_left is None else job.seconds_left for job in running)
    waiting = sum(job.state == "queued" for job in jobs)
    return (rest + usual * waiting) / max(len(running), 1)


def _part_done(running: list[JobRow]) -> float:
    return sum(job.progress for job in running) / max(len(running), 1)
