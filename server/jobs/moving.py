"""Jobs that register moving scans: what keeps one from being started, and what it is to do, settled when it is made."""

from __future__ import annotations

import uuid

from sqlalchemy.orm import Session

from server.errors import StudioError
from server.jobs import service
from server.jobs.models import ENDED_STATES, JobRow
from server.jobs.moving_schemas import RegisterMovingCreate
from server.jobs.obstacles import refuse_at
from server.moving_scans.accepted import number_registrations
from server.moving_scans.person_models import get_person_model
from server.moving_scans.registrations import get_registration
from server.moving_scans.service import get_moving_scan, list_usable
from server.moving_scans.storing import TEMPLATE, TEMPLATES
from server.storage import Storage

KIND = "register_moving"


def find_moving_obstacles(session: Session, storage: Storage, asked: RegisterMovingCreate) -> list[str]:
    """Why a moving scan cannot be registered so; empty when it can be."""
    try:
        row = get_moving_scan(session, asked.moving_scan_id)
        parent = None if asked.parent_id is None else get_registration(session, asked.parent_id)
        if asked.person_model_id is not None:
            get_person_model(session, asked.person_model_id)
    except StudioError as error:
        return [error.detail]
    last = row.frame_count - 1 if asked.last_frame is None else asked.last_frame
    if last >= row.frame_count:
        return [f"“{row.name}” has no frame {last}; it has 0 to {row.frame_count - 1}."]
    if asked.first_frame > last:
        return [f"The first frame, {asked.first_frame}, is after the last one, {last}."]
    if not list_usable(row, asked.first_frame, last):
        return [f"None of the frames {asked.first_frame} to {last} of “{row.name}” can be used. Choose others."]
    if parent is None:
        return []
    if asked.person_model_id is not None:
        return ["A registration that goes on from another has its model of the person. Leave one of the two out."]
    if parent.moving_scan_id != row.id:
        return [f"The registration {parent.id} is of another moving scan than “{row.name}”."]
    if not (storage.folder(TEMPLATES, parent.template_id) / TEMPLATE).is_file():
        return ["The registration to go on from has no model of the person yet. Wait until its first frame is done."]
    job = session.get(JobRow, parent.job_id)
    if job is not None and job.state not in ENDED_STATES:
        return ["The registration to go on from is still being made. Wait for the end of its job, or cancel it."]
    return []


def make_moving_job(session: Session, storage: Storage, asked: RegisterMovingCreate, account_id: uuid.UUID) -> JobRow:
    """Queue the registration of a moving scan."""
    refuse_at(find_moving_obstacles(session, storage, asked))
    row = get_moving_scan(session, asked.moving_scan_id)
    last = row.frame_count - 1 if asked.last_frame is None else asked.last_frame
    params = {**asked.model_dump(mode="json", exclude={"kind"}), "last_frame": last}
    is_whole = (asked.first_frame, last) == (0, row.frame_count - 1)
    part = "" if is_whole else f", frames {asked.first_frame} to {last}"
    if asked.parent_id is not None:
        parent = get_registration(session, asked.parent_id)
        number = number_registrations(session, {row.id})[parent.id]
        params |= {"population": parent.population}
        part += f", on from registration {number}"
    elif asked.person_model_id is not None:
        model = get_person_model(session, asked.person_model_id)
        params |= {"population": model.population}
        part += f", with the model {model.name[:60]}"
    title = f"{row.name[:200]}{part}, {PRIOR_WORDS[asked.prior]}"
    return service.create_job(
        session, KIND, None, params, created_by=account_id, title=title, moving_scan_id=asked.moving_scan_id
    )


PRIOR_WORDS = {"mixture": "mixture prior", "gaussian": "Gaussian prior", "none": "no prior"}


def read_moving(job: JobRow) -> RegisterMovingCreate:
    """What was asked of such a job."""
    return RegisterMovingCreate.model_validate(job.params)
