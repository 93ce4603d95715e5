"""What jobs have found in the images of a recording: `detections/<job id>.json`, written once."""

from __future__ import annotations

import uuid

from sqlalchemy import select
from sqlalchemy.orm import Session

from server.jobs.models import JobRow

AREA = "detections"


def find_detections(session: Session, sequence_id: uuid.UUID) -> uuid.UUID | None:
    """The job that was the last to find the hands of a recording; None where none has."""
    query = select(JobRow.id).where(
        JobRow.sequence_id == sequence_id, JobRow.kind == "detect", JobRow.state == "succeeded"
    )
    return session.scalars(query.order_by(JobRow.ended_at.desc(), JobRow.id).limit(1)).one_or_none()
