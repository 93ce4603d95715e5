"""What a job does to judge the model that it trained, on people whom nothing was learnt from."""

from __future__ import annotations

import logging
import os
from typing import TYPE_CHECKING, Any
from uuid import UUID

import numpy as np

from server.hand_models.models import HandModelRow
from server.hand_models.storing import UNTRAINED_ID
from server.jobs.checkpoints import JobCheckpoints
from server.jobs.held_out import choose_held_out, make_rule
from server.jobs.progress import JobProgress
from server.jobs.restarting import read_loop
from server.jobs.scan_run import ScanRun, Span
from server.jobs.train_schemas import TrainingParams
from server.registrations import service as registrations
from server.registrations.training_set_schemas import TrainingRule
from server.registrations.training_sets import get_training_set
from server.scans import service as scans
from server.scans.cropping import find_cropped

if TYPE_CHECKING:
    from tracker import BlendModel
    from tracker.evaluation import HeldOut
    from tracker.training import TrainingSet

log = logging.getLogger(__name__)


def evaluate_model(run: ScanRun, attempt: int, model_id: UUID, parent_id: UUID, number: int, span: Span) -> bool:
    """Judge a model and add what was found to its report; whether there was anybody to judge it on."""
    from tracker import say_count
    from tracker.evaluation import STUDY_LEVELS, study_held_out
    from tracker.training import TrainingOptions

    level = run.row.params["evaluate"]
    with run.context.database.reading() as session:
        row = session.get_one(HandModelRow, model_id)
    if row.report is None or "level" in row.report.get("study", {}):
        return row.report is not None
    progress = run.progress(attempt)
    progress.part(span, "gathering scans of people kept for testing", 0.0)
    chosen = STUDY_LEVELS[level]
    held_out = _gather_held_out(run, row, parent_id, number, chosen.hands, progress)
    if held_out is None:
        progress.log("warning", "nobody kept for testing has a registration that counts: not evaluated")
        return False
    learned = run.cache.get(model_id)[1]
    _, parent = run.cache.get(parent_id)
    assert row.training_set_id is not None, "a trained model has a training set"
    training_set = run.load_training_set(row.training_set_id, number) if chosen.trains_others else _nothing(learned)
    params = TrainingParams.model_validate(run.row.params["options"])
    study = study_held_out(
        learned,
        _list_compared(learned, parent, parent_id),
        held_out,
        training_set,
        parent,
        TrainingOptions(threads=os.cpu_count() or 1, **params.model_dump()),
        chosen,
        lambda stage, share: progress.part(span, f"evaluating {stage}", share),
        JobCheckpoints(run.files, f"evaluate-{number}", lambda stage: progress.kept()),
    )
    with run.context.database.writing() as session:
        stored = session.get_one(HandModelRow, model_id)
        assert stored.report is not None, "it had one before"
        found = stored.report.get("study", {}) | study | {"level": level}
        stored.report = {**stored.report, "study": found}
    scanned, people = say_count(study["scans"], "scan"), say_count(len(study["people"]), "person", "people")
    progress.log("info", f"{row.name} is evaluated on {scanned} of {people}")
    return True


def _list_compared(learned: BlendModel, parent: BlendModel, parent_id: UUID) -> dict[str, BlendModel]:
    """The untrained hand, and the model that training began with where that is another one."""
    from tracker import untrained_hand

    compared = {} if parent_id == UNTRAINED_ID else {"the model before": parent}
    crude = untrained_hand("right")
    return compared | ({"untrained": crude} if np.array_equal(crude.faces, learned.faces) else {})


def _nothing(model: BlendModel) -> TrainingSet:
    from tracker.training import make_training_set

    return make_training_set(np.empty((0, *model.template.shape)), [], [], [])


def _gather_held_out(
    run: ScanRun, row: HandModelRow, parent_id: UUID, number: int, most: int, progress: JobProgress
) -> HeldOut | None:
    """Scans with their registrations: the same ones whenever this is done again."""
    from tracker import TrackerError, load_registration
    from tracker.evaluation import HeldOut, choose_held_out, make_test_hand

    ids = _list_registrations(run, row, parent_id, number)
    found = [load_registration(run.context.storage.folder(registrations.AREA, id_) / registrations.FILE) for id_ in ids]
    flats, judged = choose_held_out([one.subject for one in found], [one.pose for one in found], most)
    hands = []
    for place in judged:
        with run.context.database.reading() as session:
            registration = registrations.get_registration(session, ids[place])
            scan_row = scans.get_scan(session, registration.scan_id, deleted_too=True)
            crop = scans.read_crop(scans.get_crop(session, scan_row.id, registration.crop_revision))
        try:
            whole = scans.open_scan(run.context.storage, scan_row)
            hands.append(make_test_hand(whole.select(~find_cropped(whole, crop)), found[place]))
        except TrackerError as error:
            log.warning("scan %s is not judged on: %s", scan_row.id, error)
            progress.log("warning", f"{scan_row.name} is not judged on: its file cannot be used")
    if not hands:
        return None
    flip = np.array([-1.0, 1.0, 1.0])
    return HeldOut(
        tuple(hands),
        {
            subject: found[place].vertices * (flip if found[place].side == "left" else 1.0)
            for subject, place in flats.items()
        },
    )


def _list_registrations(run: ScanRun, row: HandModelRow, parent_id: UUID, number: int) -> list[UUID]:
    """As chosen when this was first begun: a step that is done again must not see later decisions."""
    step = f"held-out-{number}"
    kept: dict[str, Any] | None = run.files.read_manifest(step)
    if kept is None:
        with run.context.database.reading() as session:
            if run.row.kind == "loop":
                asked = read_loop(run.row)
                subjects = asked.leave_out_subjects
                rule = make_rule(asked, parent_id if asked.by == "verdict" else None)
            else:
                assert row.training_set_id is not None, "a trained model has a training set"
                subjects = run.row.params["test_subjects"]
                rule = TrainingRule.model_validate(get_training_set(session, row.training_set_id).rule)
            chosen = choose_held_out(session, rule, subjects)
            listed = [str(one.registration.id) for one in chosen]
        kept = run.files.write_manifest(step, [], {"registrations": listed})
    return [UUID(id_) for id_ in kept["registrations"]]
