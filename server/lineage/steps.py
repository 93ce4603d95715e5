"""Single steps from a thing to what it was made from, and to what was made of it."""

from __future__ import annotations

import uuid
from collections.abc import Iterable

from sqlalchemy import select
from sqlalchemy.orm import Session

from server.hand_models.models import HandModelRow
from server.lineage.schemas import Kind
from server.moving_scans.models import (
    BodySetRow,
    FrameRegistrationRow,
    MovingRegistrationRow,
    PersonModelRow,
    StretchDecisionRow,
)
from server.registrations.decision_models import DecisionRow
from server.registrations.models import RegistrationRow
from server.registrations.training_set_models import TrainingMemberRow

Ids = set[uuid.UUID]
Step = list[tuple[Kind, list[uuid.UUID | None]]]
AT_ONCE = 500
"""Ids in one query."""


def find_sources(session: Session, kind: Kind, ids: Ids) -> Step:
    """What things of a kind were made from."""

    def pick(wanted: object, by: object) -> list[uuid.UUID | None]:
        return _pick(session, wanted, by, ids)

    if kind == "hand_model":
        return [
            ("training_set", pick(HandModelRow.training_set_id, HandModelRow.id)),
            ("hand_model", pick(HandModelRow.parent_id, HandModelRow.id)),
        ]
    if kind == "training_set":
        member = TrainingMemberRow
        return [
            ("decision", pick(member.decision_id, member.training_set_id)),
            ("registration", pick(member.registration_id, member.training_set_id)),
        ]
    if kind == "decision":
        return [("registration", pick(DecisionRow.registration_id, DecisionRow.id))]
    if kind == "registration":
        row = RegistrationRow
        return [("scan", pick(row.scan_id, row.id)), ("hand_model", pick(row.model_id, row.id))]
    if kind == "body_set":
        sets = session.scalars(select(BodySetRow.members).where(BodySetRow.id.in_(ids)))
        members = [member for each in sets for member in each]
        laid, frame = _read_ids(members, "frame_registration_id"), FrameRegistrationRow
        return [
            ("stretch_decision", list(_read_ids(members, "decision_id"))),
            ("moving_registration", _pick(session, frame.registration_id, frame.id, laid)),
        ]
    if kind == "stretch_decision":
        return [("moving_registration", pick(StretchDecisionRow.registration_id, StretchDecisionRow.id))]
    if kind == "moving_registration":
        made = MovingRegistrationRow
        models = {id_ for id_ in pick(made.template_id, made.id) if id_ is not None}
        return [
            ("moving_scan", pick(made.moving_scan_id, made.id)),
            ("moving_registration", pick(made.parent_id, made.id)),
            ("person_model", _pick(session, PersonModelRow.id, PersonModelRow.id, models)),
        ]
    if kind == "person_model":
        return [("body_set", pick(PersonModelRow.body_set_id, PersonModelRow.id))]
    return []


def find_results(session: Session, kind: Kind, ids: Ids) -> Step:
    """What was made of things of a kind."""

    def pick(wanted: object, by: object) -> list[uuid.UUID | None]:
        return _pick(session, wanted, by, ids)

    if kind == "scan":
        return [("registration", pick(RegistrationRow.id, RegistrationRow.scan_id))]
    if kind == "registration":
        return [
            ("decision", pick(DecisionRow.id, DecisionRow.registration_id)),
            ("training_set", pick(TrainingMemberRow.training_set_id, TrainingMemberRow.registration_id)),
        ]
    if kind == "decision":
        return [("training_set", pick(TrainingMemberRow.training_set_id, TrainingMemberRow.decision_id))]
    if kind == "training_set":
        return [("hand_model", pick(HandModelRow.id, HandModelRow.training_set_id))]
    if kind == "hand_model":
        return [
            ("hand_model", pick(HandModelRow.id, HandModelRow.parent_id)),
            ("registration", pick(RegistrationRow.id, RegistrationRow.model_id)),
        ]
    if kind == "moving_scan":
        return [("moving_registration", pick(MovingRegistrationRow.id, MovingRegistrationRow.moving_scan_id))]
    if kind == "moving_registration":
        return [
            ("stretch_decision", pick(StretchDecisionRow.id, StretchDecisionRow.registration_id)),
            ("moving_registration", pick(MovingRegistrationRow.id, MovingRegistrationRow.parent_id)),
        ]
    if kind == "stretch_decision":
        scans = pick(StretchDecisionRow.moving_scan_id, StretchDecisionRow.id)
        query = select(BodySetRow.id, BodySetRow.members).where(BodySetRow.moving_scan_id.in_(scans))
        rows = session.execute(query)
        return [("body_set", [id_ for id_, members in rows if _read_ids(members, "decision_id") & ids])]
    if kind == "body_set":
        return [("person_model", pick(PersonModelRow.id, PersonModelRow.body_set_id))]
    if kind == "person_model":
        return [("moving_registration", pick(MovingRegistrationRow.id, MovingRegistrationRow.template_id))]
    return []


def _pick(session: Session, wanted: object, by: object, ids: Ids) -> list[uuid.UUID | None]:
    """Values of one column where another is among the ids."""
    listed = list(ids)
    return [
        value
        for first in range(0, len(listed), AT_ONCE)
        for value in session.scalars(
            select(wanted).where(by.in_(listed[first : first + AT_ONCE])).distinct()  # type: ignore[attr-defined,arg-type]
        )
    ]


def _read_ids(members: Iterable[dict[str, str]], name: str) -> Ids:
    """Ids that the frames of a set name."""
    return {uuid.UUID(member[name]) for member in members}
