"""Rules of what loops train from, and people that models are judged on."""

from __future__ import annotations

import uuid
from collections.abc import Sequence

from sqlalchemy.orm import Session

from server.jobs.loop_schemas import LoopCreate
from server.registrations.training_set_schemas import TrainingRule
from server.registrations.training_sets import Chosen, choose_registrations


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
