"""What keeps a job from being started: asked by forms before, and by the code that makes the job."""

from __future__ import annotations

import uuid
from collections.abc import Sequence
from typing import Any

from sqlalchemy import select
from sqlalchemy.orm import Session

from server.errors import StudioError
from server.hand_models.service import get_hand_model
from server.hand_models.storing import UNTRAINED_ID, UNTRAINED_NAME, find_file
from server.jobs import service, workers
from server.jobs.register_schemas import RegisterCreate
from server.jobs.scan_choice import AT_ONCE, choose_scans
from server.jobs.schemas import JobCheck
from server.scans.models import ScanRow
from server.scans.units import find_rows_out_of_size
from server.storage import Storage


def refuse_at(obstacles: Sequence[str]) -> None:
    """Raise when there are any."""
    if obstacles:
        raise service.CannotStartError(" ".join(obstacles), obstacles=list(obstacles))


def make_check(session: Session, obstacles: Sequence[str], notes: Sequence[str] = ()) -> JobCheck:
    """The answer to a form that asks; says too when a job would wait for want of a worker."""
    now = workers.find_database_time(session)
    if not any(workers.is_alive(worker, now) for worker in workers.list_workers(session)):
        notes = [*notes, "No worker is running: the job waits until one is started with “handloom worker”."]
    return JobCheck(can_start=not obstacles, obstacles=list(obstacles), notes=list(notes))


def find_track_obstacles(session: Session, sequence_id: uuid.UUID, params: dict[str, Any]) -> list[str]:
    """Why a recording cannot be tracked with these options; empty when it can be."""
    from tracker import TrackerError

    try:
        service.check_track_params(session, sequence_id, params)
    except (StudioError, TrackerError) as error:
        return [str(error)]
    return []


def find_detect_obstacles(session: Session, sequence_id: uuid.UUID) -> list[str]:
    """Why the hand detector cannot look at a recording; empty when it can."""
    try:
        service.check_detection(session, sequence_id)
    except StudioError as error:
        return [error.detail]
    return []


def find_register_obstacles(session: Session, storage: Storage, asked: RegisterCreate) -> list[str]:
    """Why no scan can be registered so; empty when some can be."""
    obstacles = find_model_obstacles(session, storage, asked.model_id)
    if obstacles:
        return obstacles
    model_id = asked.model_id or UNTRAINED_ID
    if scans := choose_scans(session, asked, model_id):
        return find_size_obstacles(session, scans)
    where = (f" of {asked.collection}" if asked.collection else "") + (f" of {asked.subject}" if asked.subject else "")
    there = len(choose_scans(session, asked.model_copy(update={"only": "all"}), model_id))
    if there == 0:
        return [f"There is no scan{where} to register. Add scans first, or choose others."]
    those = "the one scan" if there == 1 else f"all {there} scans"
    if asked.only == "new":
        name = UNTRAINED_NAME if model_id == UNTRAINED_ID else get_hand_model(session, model_id).name
        return [f"{name} has registered {those}{where} as cropped now. Choose all scans to register them once more."]
    return [
        f"Somebody has accepted the newest registration of {those}{where}. Choose all scans to register them once more."
    ]


def find_size_obstacles(session: Session, scans: Sequence[uuid.UUID]) -> list[str]:
    """Which of these scans have a size that no hand has, so that registering them would fail."""
    from tracker.capture import SIZES_NEEDED

    faults: dict[str, str] = {}
    for first in range(0, len(scans), AT_ONCE):
        query = select(ScanRow).where(ScanRow.id.in_(scans[first : first + AT_ONCE]))
        faults |= find_rows_out_of_size(session.scalars(query).all())
    if not faults:
        return []
    told = "; ".join(f"{name} {fault}" for name, fault in list(faults.items())[:5])
    more = f"; and {len(faults) - 5} others" if len(faults) > 5 else ""
    return [
        f"{len(faults)} of {len(scans)} scans have a size that no hand has ({told}{more}); needed {SIZES_NEEDED}. "
        "Correct their unit, crop what is not a hand, or choose other scans."
    ]


def find_model_obstacles(
    session: Session, storage: Storage, model_id: uuid.UUID | None, *, deleted_too: bool = False
) -> list[str]:
    """Why a hand model cannot be used; empty when it can be."""
    if model_id in (None, UNTRAINED_ID):
        return []
    try:
        find_file(storage, get_hand_model(session, model_id, deleted_too=deleted_too))
    except StudioError as error:
        return [error.detail]
    return []
