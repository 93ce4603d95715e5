"""Jobs with the names that their rows only point to."""

from __future__ import annotations

from collections.abc import Sequence

from sqlalchemy import select
from sqlalchemy.orm import Session

from server.access.service import find_names
from server.jobs.calibrating import KIND
from server.jobs.models import JobRow, WorkerRow
from server.jobs.schemas import JobOut, JobWorker
from server.jobs.service import FRAME_KINDS
from server.sequences.models import SequenceRow


def describe_jobs(session: Session, rows: Sequence[JobRow]) -> list[JobOut]:
    """Jobs as the API gives them: three queries, however many they are."""
    if not rows:
        return []
    people = find_names(session, (row.created_by for row in rows))
    about = {row.sequence_id for row in rows if row.sequence_id is not None}
    names = select(SequenceRow.id, SequenceRow.name).where(SequenceRow.id.in_(about))
    recordings = {row.id: row.name for row in session.execute(names)}
    holders = {row.worker_id for row in rows if row.worker_id is not None}
    query = select(WorkerRow).where(WorkerRow.id.in_(holders))
    workers = {worker.id: worker for worker in session.scalars(query)} if holders else {}
    own = JobOut.model_fields.keys() - {"title", "unit", "created_by_name", "worker"}
    return [
        JobOut.model_validate(
            {field: getattr(row, field) for field in own}
            | {
                "title": row.title if row.sequence_id is None else recordings[row.sequence_id],
                "unit": "frames" if row.kind in FRAME_KINDS else "cameras" if row.kind == KIND else "scans",
                "created_by_name": people.get(row.created_by),
                "worker": _describe_worker(workers.get(row.worker_id)) if row.worker_id is not None else None,
            }
        )
        for row in rows
    ]


def describe_job(session: Session, row: JobRow) -> JobOut:
    """One job as the API gives it."""
    return describe_jobs(session, [row])[0]


def _describe_worker(row: WorkerRow | None) -> JobWorker | None:
    return None if row is None else JobWorker(id=row.id, name=row.slot, host=row.host)
