"""Jobs that register scans and train hand models: what they do is settled when they are made."""

from __future__ import annotations

import uuid
from collections.abc import Sequence
from typing import Any

from sqlalchemy import insert, select
from sqlalchemy.orm import Session

from server.hand_models.storing import resolve_model
from server.jobs import service
from server.jobs.loop_schemas import LoopCreate
from server.jobs.models import JobRow, JobScanRow
from server.jobs.obstacles import find_register_obstacles, refuse_at
from server.jobs.register_schemas import RegisterCreate
from server.jobs.scan_choice import choose_scans, list_loop_scans
from server.jobs.train_schemas import TrainCreate
from server.jobs.training_obstacles import find_loop_obstacles, find_train_obstacles, list_test_subjects
from server.registrations.training_set_schemas import TrainingRule
from server.registrations.training_sets import create_training_set, get_training_set
from server.storage import Storage
from tracker import say_count


def make_register_job(session: Session, storage: Storage, asked: RegisterCreate, account_id: uuid.UUID) -> JobRow:
    """Queue the registration of some scans."""
    refuse_at(find_register_obstacles(session, storage, asked))
    model = resolve_model(session, storage, asked.model_id)
    scans = choose_scans(session, asked, model.id)
    what = say_count(len(scans), "scan")
    where = f" of {asked.collection}" if asked.collection else ""
    params = {"model_id": str(model.id), "model": model.name, "only": asked.only}
    return _make(session, "register", f"{what}{where} with {model.name}", params, account_id, scans)


def make_train_job(session: Session, storage: Storage, asked: TrainCreate, account_id: uuid.UUID) -> JobRow:
    """Queue the training of a model; what a rule chooses is kept as a training set first."""
    refuse_at(find_train_obstacles(session, storage, asked))
    if asked.rule is not None:
        training_set, _ = create_training_set(session, storage, asked.name, asked.rule, account_id)
    else:
        assert asked.training_set_id is not None, "the schema asks for one of the two"
        training_set = get_training_set(session, asked.training_set_id)
    model = resolve_model(session, storage, asked.model_id)
    params = {
        "training_set_id": str(training_set.id),
        "training_set": training_set.name,
        "model_id": str(model.id),
        "model": model.name,
        "name": asked.name,
        "options": asked.options.model_dump(),
        "evaluate": asked.evaluate,
    }
    if asked.evaluate != "no":
        params["test_subjects"] = list_test_subjects(asked, TrainingRule.model_validate(training_set.rule))
    title = asked.name if asked.name == training_set.name else f"{asked.name} from {training_set.name}"
    return _make(session, "train", title, params, account_id, [])


def make_loop_job(session: Session, storage: Storage, asked: LoopCreate, account_id: uuid.UUID) -> JobRow:
    """Queue register, choose, train, register again."""
    scans = list_loop_scans(session, asked)
    refuse_at(find_loop_obstacles(session, storage, asked, scans))
    model = resolve_model(session, storage, asked.model_id)
    params = {**asked.model_dump(mode="json"), "model_id": str(model.id), "model": model.name}
    rounds = say_count(asked.rounds, "round")
    return _make(
        session, "loop", f"{asked.name}: {rounds} over {say_count(len(scans), 'scan')}", params, account_id, scans
    )


def copy_job_scans(session: Session, source_id: uuid.UUID, job_id: uuid.UUID) -> None:
    """Have a retry work on the scans of the job that it retries."""
    _add_scans(session, job_id, list_job_scans(session, source_id))


def list_job_scans(session: Session, job_id: uuid.UUID) -> list[uuid.UUID]:
    """Scans that a job is to register, in their order."""
    query = select(JobScanRow.scan_id).where(JobScanRow.job_id == job_id).order_by(JobScanRow.number)
    return list(session.scalars(query))


def _make(
    session: Session, kind: str, title: str, params: dict[str, Any], account_id: uuid.UUID, scans: Sequence[uuid.UUID]
) -> JobRow:
    job = service.create_job(session, kind, None, params, created_by=account_id, title=title[:300])
    _add_scans(session, job.id, scans)
    return job


def _add_scans(session: Session, job_id: uuid.UUID, scans: Sequence[uuid.UUID]) -> None:
    rows = [
        {"id": uuid.uuid4(), "job_id": job_id, "number": number, "scan_id": scan_id}
        for number, scan_id in enumerate(scans)
    ]
    if rows:
        session.execute(insert(JobScanRow), rows)
