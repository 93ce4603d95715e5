"""What keeps a hand model from being trained, known before a job is made."""

from __future__ import annotations

import uuid
from collections.abc import Collection, Sequence
from pathlib import Path

import numpy as np
from sqlalchemy import select
from sqlalchemy.orm import Session

from server.hand_models.models import HandModelRow
from server.hand_models.storing import UNTRAINED_ID
from server.jobs.held_out import choose_held_out, make_rule
from server.jobs.loop_schemas import LoopCreate
from server.jobs.obstacles import find_model_obstacles, find_size_obstacles
from server.jobs.train_schemas import TrainCreate
from server.registrations import service as registrations
from server.registrations.training_set_schemas import TrainingRule
from server.registrations.training_sets import Chosen, choose_members, choose_registrations, get_training_set, preview
from server.scans.models import ScanRow
from server.storage import Storage

NOBODY_LEFT_OUT = "Nobody is kept for testing, so there is nobody to evaluate on. Leave subjects out."

AT_A_TIME = 40
"""Registrations whose poses are looked at, until fingers are seen to bend."""


def find_train_obstacles(session: Session, storage: Storage, asked: TrainCreate) -> list[str]:
    """Why no model can be trained so; empty when one can be."""
    if asked.rule is not None:
        rule, chosen = asked.rule, choose_registrations(session, asked.rule)
    else:
        assert asked.training_set_id is not None, "the schema asks for one of the two"
        row = get_training_set(session, asked.training_set_id)
        rule, chosen = TrainingRule.model_validate(row.rule), choose_members(session, row.id)
    obstacles = find_model_obstacles(session, storage, asked.model_id)
    if not obstacles:
        obstacles = _find_faults(session, storage, chosen, asked.model_id, asked.options.with_mirrored)
        if obstacles and asked.rule is not None:
            obstacles += _say_what_waits(session, rule)
    return obstacles if asked.evaluate == "no" else obstacles + _find_test_obstacles(session, asked, rule, chosen)


def find_loop_obstacles(session: Session, storage: Storage, asked: LoopCreate, scans: Sequence[uuid.UUID]) -> list[str]:
    """Why a loop over these scans cannot come to its end; empty when it can, if registrations come out well."""
    if not scans:
        where = f" in {asked.collection}" if asked.collection else ""
        return [f"There are no scans{where}. Add some, or choose another collection."]
    obstacles = find_model_obstacles(session, storage, asked.model_id) + find_size_obstacles(session, scans)
    if asked.by == "decisions" and asked.rounds != 1:
        obstacles.append(
            f"rounds is {asked.rounds}; by people's decisions it is 1: what the new model registers waits for people."
        )
    if asked.evaluate != "no":
        obstacles += _find_left_out_faults(session, asked, scans)
    if obstacles:
        return obstacles
    if asked.by == "decisions":
        rule = make_rule(asked, None)
        chosen = choose_registrations(session, rule)
        obstacles = _find_faults(session, storage, chosen, asked.model_id, asked.options.with_mirrored)
        return obstacles + (_say_what_waits(session, rule) if obstacles else [])
    return _find_scan_faults(session, asked, scans)


def list_test_subjects(asked: TrainCreate, rule: TrainingRule) -> list[str]:
    """People to judge on: those asked for, else those whom the rule leaves out."""
    return sorted(set(asked.test_subjects) or set(rule.leave_out_subjects))


def _find_faults(
    session: Session, storage: Storage, chosen: Sequence[Chosen], model_id: uuid.UUID | None, with_mirrored: bool
) -> list[str]:
    """What the training itself would refuse."""
    from tracker.training import TrainingHand, find_training_faults

    counts = _count_vertices(session, {one.registration.model_id for one in chosen})
    hands = [
        TrainingHand(one.scan.subject, one.registration.side == "left", counts[one.registration.model_id])
        for one in chosen
    ]
    faults = find_training_faults(hands, *_describe_first(session, model_id), with_mirrored)
    return faults or _find_bend_faults(storage, chosen)


def _describe_first(session: Session, model_id: uuid.UUID | None) -> tuple[str, str, int]:
    """Name, side and number of vertices of the model that training begins with."""
    row = session.get(HandModelRow, model_id or UNTRAINED_ID)
    if row is not None:
        return row.name, row.side, int(row.facts["vertices"])
    from tracker import untrained_hand

    model = untrained_hand("right")
    return model.name, model.side, len(model.template)


def _count_vertices(session: Session, model_ids: Collection[uuid.UUID]) -> dict[uuid.UUID, int]:
    rows = session.execute(select(HandModelRow.id, HandModelRow.facts).where(HandModelRow.id.in_(model_ids)))
    return {row.id: int(row.facts["vertices"]) for row in rows}


def _find_bend_faults(storage: Storage, chosen: Sequence[Chosen]) -> list[str]:
    """Whether fingers bend anywhere: some registrations are looked at, more only while they do not."""
    from tracker.training import find_bend_fault

    fault, turns = None, []
    for first in range(0, len(chosen), AT_A_TIME):
        for one in chosen[first : first + AT_A_TIME]:
            path = storage.folder(registrations.AREA, one.registration.id) / registrations.FILE
            if (pose := _read_pose(path)) is not None:
                turns.append(pose[1:])
        fault = find_bend_fault(np.array(turns)) if turns else None
        if fault is None:
            return []
    return [] if fault is None else [fault]


def _read_pose(path: Path) -> np.ndarray | None:
    """None for a file that is damaged: the job hashes every file, and names it."""
    from tracker import TrackerError, load_registration

    try:
        return load_registration(path).pose
    except (TrackerError, OSError):
        return None


def _say_what_waits(session: Session, rule: TrainingRule) -> list[str]:
    """The next step, where people have not decided yet."""
    waiting = preview(session, rule).undecided if rule.by == "decisions" else 0
    if waiting == 0:
        return []
    waits = "1 registration waits" if waiting == 1 else f"{waiting} registrations wait"
    return [f"{waits} for a decision on the page Curate."]


def _find_test_obstacles(
    session: Session, asked: TrainCreate, rule: TrainingRule, chosen: Sequence[Chosen]
) -> list[str]:
    """Why a model cannot be judged: nobody it learns from may be among those, and all must have registrations."""
    subjects = list_test_subjects(asked, rule)
    if not subjects:
        return [NOBODY_LEFT_OUT]
    if known := sorted({one.scan.subject for one in chosen} & set(subjects)):
        return [
            f"{known[0]} is in the training set: a model is judged on people that it was not trained on. Leave out "
            "those to judge on when the training set is made."
        ]
    kept = choose_held_out(session, rule, subjects)
    there = {one.scan.subject for one in kept}
    if missing := [subject for subject in subjects if subject not in there]:
        how = "that was accepted" if rule.by == "decisions" else "that is good"
        return [
            f"{missing[0]} has no registration {how}, so there is nothing to judge on. Register their scans"
            f"{' and decide about them' if rule.by == 'decisions' else ''}, or do not name them."
        ]
    name, _, vertices = _describe_first(session, asked.model_id)
    counts = _count_vertices(session, {one.registration.model_id for one in kept})
    if others := sorted({one.scan.subject for one in kept if counts[one.registration.model_id] != vertices}):
        return [
            f"{others[0]} was registered with a model of another mesh than {name}. Register their scans with {name}."
        ]
    return []


def _find_scan_faults(session: Session, asked: LoopCreate, scans: Sequence[uuid.UUID]) -> list[str]:
    """What training would refuse even if every scan came out well."""
    from tracker.training import TrainingHand, find_training_faults

    name, side, vertices = _describe_first(session, asked.model_id)
    learnt = [one for one in _list_scans(session, scans) if one.subject not in asked.leave_out_subjects]
    untold = {one.subject for one in learnt if one.side is None}  # their scans may all be of one hand
    hands = [TrainingHand(one.subject, one.side == "left" and one.subject not in untold, vertices) for one in learnt]
    return find_training_faults(hands, name, side, vertices, asked.options.with_mirrored)


def _find_left_out_faults(session: Session, asked: LoopCreate, scans: Sequence[uuid.UUID]) -> list[str]:
    """Why there is nobody to judge the models of a loop on."""
    if not asked.leave_out_subjects:
        return [NOBODY_LEFT_OUT]
    there = {one.subject for one in _list_scans(session, scans)}
    missing = [subject for subject in asked.leave_out_subjects if subject not in there]
    return [f"There is no scan of {missing[0]}, so there is nothing to judge on. Do not name them."] if missing else []


def _list_scans(session: Session, ids: Sequence[uuid.UUID]) -> list[ScanRow]:
    wanted = set(ids)
    return [row for row in session.scalars(select(ScanRow).where(ScanRow.deleted_at.is_(None))) if row.id in wanted]
