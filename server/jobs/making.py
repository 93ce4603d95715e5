"""Jobs that register scans and train hand models: what they are to do is settled when they are made."""

from __future__ import annotations

import uuid
from collections.abc import Sequence
from typing import Any

from sqlalchemy import insert, select
from sqlalchemy.orm import Session

from server.errors import InvalidError, NotFoundError
from server.hand_models.models import HandModelRow
from server.hand_models.storing import resolve_model
from server.jobs import service
from server.jobs.models import JobRow, JobScanRow
from server.jobs.schemas import LoopCreate, RegisterCreate, TrainCreate
from server.registrations.models import RegistrationRow
from server.scans.models import ScanRow
from server.storage import Storage
from server.training_sets.models import TrainingSetRow
from server.training_sets.schemas import TrainingRule
from server.training_sets.service import Chosen, choose_registrations, get_training_set, list_subjects

AT_ONCE = 500

NOBODY_LEFT_OUT = "Nobody is kept for testing, so there is nobody to evaluate on. Leave subjects out."


def make_register_job(session: Session, storage: Storage, asked: RegisterCreate, account_id: uuid.UUID) -> JobRow:
    """Queue the registration of some scans."""
    model = resolve_model(session, storage, asked.model_id)
    scans = _choose_scans(session, asked, model)
    if not scans:
        raise InvalidError(
            "There is no such scan to register. Upload scans, choose others, or register all again with `only`: `all`."
        )
    what = "1 scan" if len(scans) == 1 else f"{len(scans)} scans"
    where = f" of {asked.collection}" if asked.collection else ""
    params = {"model_id": str(model.id), "model": model.name, "only": asked.only}
    return _make(session, "register", f"{what}{where} with {model.name}", params, account_id, scans)


def make_train_job(session: Session, storage: Storage, asked: TrainCreate, account_id: uuid.UUID) -> JobRow:
    """Queue the training of a model."""
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
        params["test_subjects"] = _check_test_subjects(session, training_set, asked.test_subjects)
    title = asked.name if asked.name == training_set.name else f"{asked.name} from {training_set.name}"
    return _make(session, "train", title, params, account_id, [])


def make_loop_job(session: Session, storage: Storage, asked: LoopCreate, account_id: uuid.UUID) -> JobRow:
    """Queue register, choose, train, register again."""
    if asked.by == "decisions" and asked.rounds != 1:
        raise InvalidError(
            f"rounds is {asked.rounds}; by people's decisions it is 1: what the new model registers waits for people."
        )
    if asked.evaluate != "no" and not asked.leave_out_subjects:
        raise InvalidError(NOBODY_LEFT_OUT)
    model = resolve_model(session, storage, asked.model_id)
    scans = _choose_scans(session, RegisterCreate(collection=asked.collection, only="all"), model)
    if not scans:
        raise InvalidError("There are no such scans. Upload some, or choose another collection.")
    if asked.by == "decisions" and not choose_registrations(session, make_rule(asked, None)):
        raise InvalidError("Nobody has accepted a registration of these scans. Decide first, or train by the verdict.")
    params = {**asked.model_dump(mode="json"), "model_id": str(model.id), "model": model.name}
    rounds = "1 round" if asked.rounds == 1 else f"{asked.rounds} rounds"
    return _make(session, "loop", f"{asked.name}: {rounds} over {len(scans)} scans", params, account_id, scans)


def make_rule(asked: LoopCreate, model_id: uuid.UUID | None) -> TrainingRule:
    """What a loop trains from."""
    return TrainingRule(
        by=asked.by,
        collections=[asked.collection] if asked.collection else [],
        model_id=model_id,
        leave_out_subjects=asked.leave_out_subjects,
    )


def choose_held_out(session: Session, rule: TrainingRule, subjects: Sequence[str]) -> list[Chosen]:
    """Registrations of people who are left out, chosen as a rule chooses those that are trained from."""
    rule = rule.model_copy(update={"leave_out_subjects": []})
    return [one for one in choose_registrations(session, rule) if one.scan.subject in subjects]


def _check_test_subjects(session: Session, training_set: TrainingSetRow, asked: Sequence[str]) -> list[str]:
    """Those to judge on, none of whom is learnt from and all of whom have registrations that count."""
    rule = TrainingRule.model_validate(training_set.rule)
    subjects = sorted(set(asked) or set(rule.leave_out_subjects))
    if not subjects:
        raise InvalidError(NOBODY_LEFT_OUT)
    if known := sorted(list_subjects(session, training_set.id) & set(subjects)):
        raise InvalidError(
            f"{known[0]} is in the training set: a model is judged on people that it was not trained on. Leave out "
            "those to judge on when the training set is made."
        )
    there = {one.scan.subject for one in choose_held_out(session, rule, subjects)}
    if missing := [subject for subject in subjects if subject not in there]:
        how = "that was accepted" if rule.by == "decisions" else "that is good"
        raise InvalidError(
            f"{missing[0]} has no registration {how}, so there is nothing to judge on. Register their scans"
            f"{' and decide about them' if rule.by == 'decisions' else ''}, or leave them out of `test_subjects`."
        )
    return subjects


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


def _choose_scans(session: Session, asked: RegisterCreate, model: HandModelRow) -> list[uuid.UUID]:
    """By name, so that what one sees grow is in order."""
    query = select(ScanRow.id).where(ScanRow.deleted_at.is_(None)).order_by(ScanRow.name, ScanRow.id)
    if asked.collection is not None:
        query = query.where(ScanRow.collection == asked.collection)
    if asked.subject is not None:
        query = query.where(ScanRow.subject == asked.subject)
    newest = select(RegistrationRow.id).where(RegistrationRow.scan_id == ScanRow.id)
    if asked.only == "new":
        done = newest.where(RegistrationRow.model_id == model.id, RegistrationRow.crop_revision == ScanRow.revision)
        query = query.where(~done.exists())
    elif asked.only == "not_accepted":
        query = query.where(~newest.where(RegistrationRow.is_current, RegistrationRow.decision == "accept").exists())
    if not asked.scan_ids:
        return list(session.scalars(query))
    wanted = list(dict.fromkeys(asked.scan_ids))
    there: set[uuid.UUID] = set()
    chosen: list[uuid.UUID] = []
    for first in range(0, len(wanted), AT_ONCE):
        some = wanted[first : first + AT_ONCE]
        there |= set(session.scalars(select(ScanRow.id).where(ScanRow.id.in_(some), ScanRow.deleted_at.is_(None))))
        chosen += session.scalars(query.where(ScanRow.id.in_(some)))
    if missing := [id_ for id_ in wanted if id_ not in there]:
        raise NotFoundError(
            f"There is no scan {missing[0]}" + (f", nor {len(missing) - 1} others." if len(missing) > 1 else ".")
        )
    return chosen
