"""Jobs that calibrate cameras: what keeps one from being started, and what it is to do, settled when it is made."""

from __future__ import annotations

import uuid

from sqlalchemy.orm import Session

from server.calibrations.films import find_films
from server.calibrations.models import CalibrationRow
from server.calibrations.schemas import CalibrationOptions
from server.calibrations.service import GONE, get_calibration
from server.database import utc_now
from server.errors import StudioError
from server.jobs import service
from server.jobs.models import ENDED_STATES, JobRow
from server.jobs.obstacles import refuse_at
from server.storage import Storage

KIND = "calibrate"


def find_calibrate_obstacles(
    session: Session, storage: Storage, calibration_id: uuid.UUID, *, again: bool = False
) -> list[str]:
    """Why cameras cannot be calibrated; empty when they can be.

    Args:
        session: The request's.
        storage: Where the films are.
        calibration_id: Of the films.
        again: A job that has been checked before is to go on, with its own options.
    """
    try:
        row = get_calibration(session, calibration_id)
    except StudioError as error:
        return [error.detail]
    if row.result is not None:
        return ["These cameras are calibrated already. Check them with other options to make another calibration."]
    if _is_at_work(session, row):
        return ["These cameras are being calibrated already. Wait for the end of that job, or cancel it."]
    if find_films(storage, row.films_id) is None:
        return [GONE]
    return [] if again else list(row.report["problems"])


def make_calibrate_job(session: Session, storage: Storage, calibration_id: uuid.UUID, account_id: uuid.UUID) -> JobRow:
    """Queue the calibration of cameras with the options that were checked last."""
    refuse_at(find_calibrate_obstacles(session, storage, calibration_id))
    row = get_calibration(session, calibration_id)
    options = CalibrationOptions.model_validate(row.options)
    params = {"calibration_id": str(row.id), "calibration": row.name, "options": options.model_dump()}
    job = service.create_job(session, KIND, None, params, created_by=account_id, title=row.name)
    follow_job(session, job)
    return job


def follow_job(session: Session, job: JobRow) -> None:
    """Have a calibration name the job that is to do it now."""
    row = get_calibration(session, read_calibration_id(job))
    row.job_id, row.updated_at = job.id, utc_now()
    session.flush()


def read_calibration_id(job: JobRow) -> uuid.UUID:
    """What a job of this kind calibrates."""
    return uuid.UUID(job.params["calibration_id"])


def read_calibrate_options(job: JobRow) -> CalibrationOptions:
    """How a job of this kind calibrates."""
    return CalibrationOptions.model_validate(job.params["options"])


def _is_at_work(session: Session, row: CalibrationRow) -> bool:
    job = None if row.job_id is None else session.get(JobRow, row.job_id)
    return job is not None and job.state not in ENDED_STATES
