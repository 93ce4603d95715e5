"""What each kind of job asks for: its obstacles are looked for, and it is queued."""

from __future__ import annotations

import uuid

from sqlalchemy.orm import Session

from server.access.audit import record_act
from server.calibrations.service import get_calibration
from server.jobs import service
from server.jobs.calibrate_schemas import CalibrateCreate
from server.jobs.calibrating import find_calibrate_obstacles, make_calibrate_job
from server.jobs.create_jobs import make_loop_job, make_register_job, make_train_job
from server.jobs.detect_schemas import DetectCreate
from server.jobs.loop_schemas import LoopCreate
from server.jobs.models import JobRow
from server.jobs.moving import find_moving_obstacles, make_moving_job
from server.jobs.moving_schemas import RegisterMovingCreate
from server.jobs.obstacles import find_detect_obstacles, find_register_obstacles, find_track_obstacles
from server.jobs.register_schemas import RegisterCreate
from server.jobs.scan_choice import list_loop_scans
from server.jobs.track_schemas import JobCreate
from server.jobs.train_schemas import TrainCreate
from server.jobs.training_obstacles import find_loop_obstacles, find_train_obstacles
from server.storage import Storage

OneKindCreate = (
    JobCreate | DetectCreate | RegisterCreate | TrainCreate | LoopCreate | CalibrateCreate | RegisterMovingCreate
)


def start_job(session: Session, storage: Storage, asked: OneKindCreate, account_id: uuid.UUID) -> JobRow:
    """Queue a job. Raises when it could not be done."""
    job = _make(session, storage, asked, account_id)
    record_act(session, account_id, "job.start", "job", job.id)
    return job


def _make(session: Session, storage: Storage, asked: OneKindCreate, account_id: uuid.UUID) -> JobRow:
    match asked:
        case RegisterCreate():
            return make_register_job(session, storage, asked, account_id)
        case TrainCreate():
            return make_train_job(session, storage, asked, account_id)
        case LoopCreate():
            return make_loop_job(session, storage, asked, account_id)
        case RegisterMovingCreate():
            return make_moving_job(session, storage, asked, account_id)
        case CalibrateCreate():
            get_calibration(session, asked.calibration_id)
            return make_calibrate_job(session, storage, asked.calibration_id, account_id)
        case DetectCreate():
            service.check_detection(session, asked.sequence_id)
            return service.create_job(session, "detect", asked.sequence_id, {}, created_by=account_id)
        case JobCreate():
            params = service.check_track_params(session, asked.sequence_id, asked.params)
            return service.create_job(session, "track", asked.sequence_id, params, created_by=account_id)


def find_obstacles(session: Session, storage: Storage, asked: OneKindCreate) -> list[str]:
    """Why a job cannot be started; empty when it can be."""
    match asked:
        case RegisterCreate():
            return find_register_obstacles(session, storage, asked)
        case TrainCreate():
            return find_train_obstacles(session, storage, asked)
        case LoopCreate():
            return find_loop_obstacles(session, storage, asked, list_loop_scans(session, asked))
        case RegisterMovingCreate():
            return find_moving_obstacles(session, storage, asked)
        case CalibrateCreate():
            return find_calibrate_obstacles(session, storage, asked.calibration_id)
        case DetectCreate():
            return find_detect_obstacles(session, asked.sequence_id)
        case JobCreate():
            return find_track_obstacles(session, asked.sequence_id, asked.params)
