"""Walks up and down the chains scan - registration - decision - training set - model, and moving scan - registration -
decision about a stretch - set of bodies - model of the person."""

from __future__ import annotations

import uuid
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

from sqlalchemy import select
from sqlalchemy.orm import Session

from server.access.service import find_names
from server.errors import NotFoundError
from server.hand_models.models import HandModelRow
from server.lineage.schemas import Kind, Lineage, LineageGroup, LineageItem
from server.lineage.steps import AT_ONCE, Ids, Step, find_results, find_sources
from server.moving_scans.models import (
    BodySetRow,
    MovingRegistrationRow,
    MovingScanRow,
    PersonModelRow,
    StretchDecisionRow,
)
from server.registrations.decision_models import DecisionRow
from server.registrations.models import RegistrationRow
from server.registrations.service import is_hidden_from
from server.registrations.training_set_models import TrainingSetRow
from server.scans.models import ScanRow
from tracker import say_count

MOST_ITEMS = 50


@dataclass
class _Found:
    """Ids of each kind, in the order in which the kinds were reached."""

    ids: dict[Kind, Ids] = field(default_factory=dict)

    def add(self, kind: Kind, ids: Iterable[uuid.UUID | None]) -> Ids:
        """Note ids; gives those that are new."""
        known = self.ids.setdefault(kind, set())
        new = {id_ for id_ in ids if id_ is not None} - known
        known |= new
        return new


def find_lineage(session: Session, kind: Kind, id_: uuid.UUID, reader_id: uuid.UUID) -> Lineage:
    """Where a thing comes from and what came of it, as far as the reader may see it."""
    of = _describe(session, kind, {id_}, reader_id).items
    if not of:
        raise NotFoundError(f"There is no {kind.replace('_', ' ')} {id_}.")
    up, down = _Found(), _Found()
    _walk(session, kind, {id_}, up, find_sources)
    _walk(session, kind, {id_}, down, find_results)
    return Lineage(
        of=of[0],
        comes_from=[_describe(session, *group, reader_id) for group in up.ids.items() if group[1]],
        went_into=[_describe(session, *group, reader_id) for group in down.ids.items() if group[1]],
    )


def _walk(
    session: Session,
    kind: Kind,
    ids: Ids,
    found: _Found,
    step: Callable[[Session, Kind, Ids], Step],
) -> None:
    todo: list[tuple[Kind, Ids]] = [(kind, ids)]
    while todo:
        at, some = todo.pop(0)
        for reached, more in step(session, at, some):
            if new := found.add(reached, more):
                todo.append((reached, new))


def _describe(session: Session, kind: Kind, ids: Ids, reader_id: uuid.UUID) -> LineageGroup:
    """The newest things of a kind, and how many there are."""
    listed = list(ids)
    rows = []
    table = TABLES[kind]
    for first in range(0, len(listed), AT_ONCE):
        query = select(table).where(table.id.in_(listed[first : first + AT_ONCE]))
        if kind == "decision":
            query = query.join(RegistrationRow, RegistrationRow.id == DecisionRow.registration_id)
            query = query.where(~is_hidden_from(reader_id) | (DecisionRow.account_id == reader_id))
        rows += session.scalars(query)
    rows.sort(key=lambda row: (row.created_at, row.id), reverse=True)
    shown = rows[:MOST_ITEMS]
    names = _Names(session, shown)
    return LineageGroup(kind=kind, total=len(rows), items=[names.describe(kind, row) for row in shown])


TABLES = {
    "scan": ScanRow,
    "registration": RegistrationRow,
    "decision": DecisionRow,
    "training_set": TrainingSetRow,
    "hand_model": HandModelRow,
    "moving_scan": MovingScanRow,
    "moving_registration": MovingRegistrationRow,
    "stretch_decision": StretchDecisionRow,
    "body_set": BodySetRow,
    "person_model": PersonModelRow,
}


class _Names:
    """Names of what some rows point to."""

    def __init__(self, session: Session, rows: list) -> None:
        scans = {row.scan_id for row in rows if isinstance(row, RegistrationRow)}
        models = {row.model_id for row in rows if isinstance(row, RegistrationRow | DecisionRow)}
        decided = (row.account_id for row in rows if isinstance(row, DecisionRow | StretchDecisionRow))
        self._people = find_names(session, decided)
        query = select(ScanRow.id, ScanRow.name).where(ScanRow.id.in_(scans))
        self._scans = {scan.id: scan.name for scan in session.execute(query)}
        query = select(HandModelRow.id, HandModelRow.name).where(HandModelRow.id.in_(models))
        self._models = {model.id: model.name for model in session.execute(query)}
        moving = {row.moving_scan_id for row in rows if isinstance(row, MovingRegistrationRow)}
        query = select(MovingScanRow.id, MovingScanRow.name).where(MovingScanRow.id.in_(moving))
        self._moving_scans = {scan.id: scan.name for scan in session.execute(query)}

    def describe(self, kind: Kind, row: object) -> LineageItem:
        if isinstance(row, ScanRow):
            name, detail = row.name, " ".join(filter(None, (row.subject, row.pose))) or row.collection
        elif isinstance(row, RegistrationRow):
            name, detail = self._scans[row.scan_id], f"{row.verdict}, by {self._models[row.model_id]}"
        elif isinstance(row, DecisionRow):
            name = f"{row.decision} by {self._people.get(row.account_id, '')}"
            detail = f"of a registration by {self._models[row.model_id]}"
        elif isinstance(row, TrainingSetRow):
            name, detail = (
                row.name,
                f"{say_count(row.registration_count, 'registration')}, {say_count(row.subject_count, 'subject')}",
            )
        elif isinstance(row, HandModelRow):
            name, detail = row.name, f"{row.kind}, round {row.round}"
        elif isinstance(row, MovingScanRow):
            name, detail = row.name, f"{row.subject}, {say_count(row.frame_count, 'frame')}"
        elif isinstance(row, MovingRegistrationRow):
            name = self._moving_scans[row.moving_scan_id]
            detail = f"frames {row.first_frame} to {row.last_frame}, prior {row.prior}"
        elif isinstance(row, StretchDecisionRow):
            name = f"{row.decision} by {self._people.get(row.account_id, '')}"
            detail = f"frames {row.first_frame} to {row.last_frame}"
        else:
            assert isinstance(row, BodySetRow | PersonModelRow)
            name, detail = row.name, say_count(row.frame_count, "frame")
        return LineageItem(kind=kind, id=row.id, name=name, detail=detail, created_at=row.created_at)
