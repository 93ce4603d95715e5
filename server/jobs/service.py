"""What can be done with jobs. A change of state is one conditional statement, so two processes cannot both make it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any
from uuid import UUID

from sqlalchemy import CursorResult, Select, case, func, select, update
from sqlalchemy.orm import Session

from server.database import utc_now
from server.database.paging import fetch_page
from server.database.texts import match_words
from server.detectors.models import DetectorRow
from server.detectors.service import get_detector
from server.errors import ConflictError, InvalidError, NotFoundError
from server.hand_models.service import get_hand_model
from server.jobs.models import ENDED_STATES, JobLogRow, JobRow, WorkerRow
from server.sequences.models import SequenceRow
from server.sequences.service import get_sequence

KINDS = ("track", "detect", "register", "train", "loop", "calibrate", "register_moving")
FRAME_KINDS = ("track", "detect", "register_moving")
"""Those that go through the frames of a recording, or of a moving scan."""

HAND_MODEL = "hand_model_id"
DETECTOR = "detector_id"
STUDIO_PARAMS = (HAND_MODEL, DETECTOR)
"""Among the params of a tracking job: the tracker's options know no models and no detectors of the studio."""

LOG_PAGE = 1000


class JobNotFoundError(NotFoundError):
    """There is no job of this id."""


class CannotStartError(InvalidError):
    """The job would fail; `obstacles` says why, each a sentence for people."""


class JobStateError(ConflictError):
    """The job is not in a state in which this can be done."""


def get_job(session: Session, job_id: UUID) -> JobRow:
    job = session.get(JobRow, job_id)
    if job is None:
        raise JobNotFoundError(f"There is no job {job_id}.")
    return job


@dataclass(frozen=True)
class JobFilter:
    """Which jobs are asked for; what is None or empty asks for nothing.

    Attributes:
        sequence_id: Of one recording.
        states: In one of these states.
        created_by: Started by this account.
        batch_id: Of one batch.
        search: Words that the name of the recording, or the title, holds, upper and lower case alike.
        kind: Of this kind.
        moving_scan_id: Of one moving scan.
    """

    sequence_id: UUID | None = None
    states: Sequence[str] = ()
    created_by: UUID | None = None
    batch_id: UUID | None = None
    search: str | None = None
    kind: str | None = None
    moving_scan_id: UUID | None = None

    def apply(self, query: Select[Any]) -> Select[Any]:
        for column, wanted in (
            (JobRow.sequence_id, self.sequence_id),
            (JobRow.kind, self.kind),
            (JobRow.created_by, self.created_by),
            (JobRow.batch_id, self.batch_id),
            (JobRow.moving_scan_id, self.moving_scan_id),
        ):
            if wanted is not None:
                query = query.where(column == wanted)
        if self.states:
            query = query.where(JobRow.state.in_(self.states))
        if found := match_words(self.search, SequenceRow.name, JobRow.title):
            query = query.outerjoin(SequenceRow, SequenceRow.id == JobRow.sequence_id).where(*found)
        return query


def list_jobs(
    session: Session, wanted: JobFilter, cursor: str | None, limit: int
) -> tuple[Sequence[JobRow], str | None]:
    """Newest first."""
    query = wanted.apply(select(JobRow))
    return fetch_page(session, query, (JobRow.created_at, JobRow.id), cursor, limit)


def create_job(
    session: Session,
    kind: str,
    sequence_id: UUID | None,
    params: dict[str, Any],
    *,
    created_by: UUID | None = None,
    batch_id: UUID | None = None,
    retry_of: UUID | None = None,
    title: str = "",
    moving_scan_id: UUID | None = None,
) -> JobRow:
    """Queue a job. A worker finds it as soon as the transaction is committed."""
    if kind not in KINDS:
        raise InvalidError(f"There is no kind of job {kind!r}; there are: {', '.join(KINDS)}.")
    job = JobRow(
        kind=kind,
        sequence_id=sequence_id,
        params=params,
        title=title,
        created_by=created_by,
        batch_id=batch_id,
        retry_of=retry_of,
        moving_scan_id=moving_scan_id,
    )
    session.add(job)
    session.flush()
    append_log(session, job.id, "info", "queued" if retry_of is None else f"queued again; a retry of job {retry_of}")
    return job


def check_track_params(session: Session, sequence_id: UUID, params: dict[str, Any]) -> dict[str, Any]:
    """The options in full, as they will be used; raises when the recording cannot be tracked so."""
    from tracker import TrackOptions, find_detector_faults, find_tracking_faults

    row = get_sequence(session, sequence_id)
    options = TrackOptions.from_json({name: value for name, value in params.items() if name not in STUDIO_PARAMS})
    with_depth = [camera["id"] for camera in row.cameras if camera["has_depth"]]
    with_color = [camera["id"] for camera in row.cameras if camera["has_color"]]
    faults = find_tracking_faults(row.frame_count, row.hands, with_depth, with_color, options)
    detector = _find_detector(session, params.get(DETECTOR))
    if detector is not None and not faults:
        depth_camera = None if options.view_ids or not with_depth else options.camera or with_depth[0]
        faults = find_detector_faults(detector.looks_at, depth_camera, with_color, options)
    if faults:
        raise CannotStartError(" ".join(faults), obstacles=faults)
    own = {} if detector is None else {DETECTOR: str(detector.id)}
    return options.to_json() | _check_hand_model(session, params.get(HAND_MODEL)) | own


def check_detection(session: Session, sequence_id: UUID) -> SequenceRow:
    """The recording, if the hand detector can look at it."""
    row = get_sequence(session, sequence_id)
    if not any(camera["has_color"] for camera in row.cameras):
        fault = f"{row.name} has only depth images; the hand detector needs colour or infrared ones."
        raise CannotStartError(fault, obstacles=[fault])
    return row


def _check_hand_model(session: Session, value: Any) -> dict[str, str]:
    """The id of a stored hand model, or a built-in hand's name, as a param; none for the default hand."""
    from tracker import BUILT_IN_HANDS

    if value in ("", None):
        return {}
    if value in BUILT_IN_HANDS:
        return {HAND_MODEL: value}
    needed = f"a hand model's id, {', '.join(map(repr, BUILT_IN_HANDS))}, or nothing"
    model_id = _read_id(HAND_MODEL, value, needed)
    return {HAND_MODEL: str(get_hand_model(session, model_id).id)}


def _find_detector(session: Session, value: Any) -> DetectorRow | None:
    """A stored fingertip detector by its id as a param; None for the bundled one."""
    if value in ("", None):
        return None
    return get_detector(session, _read_id(DETECTOR, value, "a fingertip detector's id, or nothing"))


def _read_id(name: str, value: Any, needed: str) -> UUID:
    try:
        return UUID(str(value))
    except ValueError:
        raise InvalidError(f"{name} is {str(value)[:80]!r}; needed {needed}.") from None


def cancel_job(session: Session, job_id: UUID) -> JobRow:
    """End a job that has not ended. Its worker notices within a frame; what is on disk stays for `resume`."""
    now = utc_now()
    if _change(
        session,
        job_id,
        JobRow.state.in_(("queued", "running")),
        state="cancelled",
        stage="cancelled",
        ended_at=now,
        seconds_left=None,
    ):
        append_log(session, job_id, "warning", "cancelled")
    job = get_job(session, job_id)
    if job.state != "cancelled":
        raise JobStateError(f"The job has {job.state}; only one that is queued or running can be cancelled.")
    return job


def retry_job(session: Session, job_id: UUID, created_by: UUID | None = None) -> JobRow:
    """A new job with the same parameters, from the beginning; in the batch of the old one it stands in its place."""
    job = get_job(session, job_id)
    if job.state not in ENDED_STATES:
        raise JobStateError(f"The job is {job.state}; cancel it first, or wait for its end.")
    return create_job(
        session,
        job.kind,
        job.sequence_id,
        job.params,
        created_by=created_by,
        batch_id=job.batch_id,
        retry_of=job.id,
        title=job.title,
        moving_scan_id=job.moving_scan_id,
    )


def resume_job(session: Session, job_id: UUID) -> JobRow:
    """Go on with a cancelled or failed job after the last chunk that was finished."""
    if not _change(
        session,
        job_id,
        JobRow.state.in_(("cancelled", "failed")),
        state="queued",
        stage="queued",
        attempt=JobRow.attempt + 1,
        worker_id=None,
        crashes=0,
        error=None,
        ended_at=None,
    ):
        raise JobStateError(
            f"The job is {get_job(session, job_id).state}; only a cancelled or failed one can be resumed."
        )
    append_log(session, job_id, "info", "queued to be resumed")
    return get_job(session, job_id)


def claim_job(session: Session, job_id: UUID, attempt: int, worker_id: UUID) -> JobRow | None:
    """Make `worker_id` the one that runs this attempt; None when the attempt is no longer wanted."""
    job = session.get(JobRow, job_id)
    if job is None or job.attempt != attempt or job.state not in ("queued", "running"):
        return None
    is_restart = job.state == "running"
    before = session.get(WorkerRow, job.worker_id) if job.worker_id is not None else None
    is_crash = is_restart and (before is None or before.state != "stopped")
    _change(
        session,
        job_id,
        (JobRow.attempt == attempt) & JobRow.state.in_(("queued", "running")),
        state="running",
        stage="starting",
        worker_id=worker_id,
        started_at=job.started_at or utc_now(),
        crashes=job.crashes + 1 if is_crash else job.crashes,
    )
    if is_restart:
        how = "crashed" if is_crash else "was stopped"
        append_log(session, job_id, "warning", f"its worker {how}; going on after the last finished step")
    session.refresh(job)
    return job


def update_running(session: Session, job_id: UUID, attempt: int, worker_id: UUID | None, **values: Any) -> bool:
    """Set columns of a running job; False when it no longer runs in this attempt on this worker, or on any if None.

    Neither its progress nor its count of frames goes back: what a crash or a cancelled attempt has cost is done again
    while both stand still. Scans are counted anew by every round of a loop.
    """
    if "progress" in values:
        values["progress"] = case((JobRow.progress > values["progress"], JobRow.progress), else_=values["progress"])
    if "frames_done" in values:
        is_behind = JobRow.kind.in_(FRAME_KINDS) & (JobRow.frames_done > values["frames_done"])
        values["frames_done"] = case((is_behind, JobRow.frames_done), else_=values["frames_done"])
    is_ours = (JobRow.state == "running") & (JobRow.attempt == attempt)
    if worker_id is not None:
        is_ours &= JobRow.worker_id == worker_id
    return _change(session, job_id, is_ours, **values)


def append_log(session: Session, job_id: UUID, level: str, text: str) -> None:
    """Add a line; its number is one more than the last, whoever else adds one to the same job."""
    session.execute(select(JobRow.id).where(JobRow.id == job_id).with_for_update(key_share=True))
    last = session.scalar(select(func.max(JobLogRow.number)).where(JobLogRow.job_id == job_id)) or 0
    session.add(JobLogRow(job_id=job_id, number=last + 1, level=level, text=text))
    session.flush()


def read_log(session: Session, job_id: UUID, after: int, limit: int = LOG_PAGE) -> list[JobLogRow]:
    """Lines with a number above `after`, in order."""
    query = select(JobLogRow).where(JobLogRow.job_id == job_id, JobLogRow.number > after)
    return list(session.scalars(query.order_by(JobLogRow.number).limit(limit)))


def _change(session: Session, job_id: UUID, condition: Any, **values: Any) -> bool:
    """Update the row of a job where `condition` holds; whether it held."""
    statement = (
        update(JobRow)
        .where(JobRow.id == job_id, condition)
        .values(version=JobRow.version + 1, updated_at=utc_now(), **values)
        .execution_options(synchronize_session=False)
    )
    result = session.execute(statement)
    assert isinstance(result, CursorResult)
    session.expire_all()
    return result.rowcount == 1
