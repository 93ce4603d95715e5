"""Which registration of each frame counts: the one that was accepted last, unless that was taken back or rejected."""

from __future__ import annotations

import uuid
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass

from sqlalchemy import select
from sqlalchemy.orm import Session

from server.access.service import find_names
from server.moving_scans.decision_schemas import AcceptedStretch
from server.moving_scans.decisions import find_standing, list_decisions
from server.moving_scans.models import FrameRegistrationRow, MovingRegistrationRow, StretchDecisionRow


@dataclass(frozen=True)
class Accepted:
    """A frame, the registration of it that counts, and who says so."""

    frame: int
    frame_registration_id: uuid.UUID
    digest: str
    registration_id: uuid.UUID
    decision_id: uuid.UUID


def find_last(standing: Sequence[StretchDecisionRow], registration_id: uuid.UUID) -> dict[int, StretchDecisionRow]:
    """The last decision about each frame of a registration, by the frame."""
    last: dict[int, StretchDecisionRow] = {}
    for row in standing:
        if row.registration_id == registration_id:
            last |= dict.fromkeys(range(row.first_frame, row.last_frame + 1), row)
    return last


def find_accepted(session: Session, moving_scan_id: uuid.UUID) -> list[Accepted]:
    """The frames of a moving scan that are accepted, in order."""
    standing = find_standing(list_decisions(session, moving_scan_id))
    judged = {row.registration_id for row in standing}
    last = {id_: find_last(standing, id_) for id_ in judged}
    query = select(FrameRegistrationRow).where(FrameRegistrationRow.registration_id.in_(judged))
    best: dict[int, tuple[int, Accepted]] = {}
    for row in session.scalars(query):
        decision = last[row.registration_id].get(row.frame)
        if decision is None or decision.decision != "accept":
            continue
        if row.frame not in best or best[row.frame][0] < decision.number:
            found = Accepted(row.frame, row.id, row.digest, row.registration_id, decision.id)
            best[row.frame] = decision.number, found
    return [best[frame][1] for frame in sorted(best)]


def count_accepted(session: Session, moving_scan_ids: Sequence[uuid.UUID]) -> dict[uuid.UUID, int]:
    """How many frames of each moving scan are accepted; those without decisions are left out."""
    query = select(StretchDecisionRow.moving_scan_id).where(StretchDecisionRow.moving_scan_id.in_(moving_scan_ids))
    return {id_: len(find_accepted(session, id_)) for id_ in session.scalars(query.distinct())}


def describe_stretches(session: Session, accepted: Sequence[Accepted]) -> list[AcceptedStretch]:
    """Frames in a row with one registration and one decision, taken together."""
    registrations = _fetch(session, MovingRegistrationRow, {each.registration_id for each in accepted})
    decisions = _fetch(session, StretchDecisionRow, {each.decision_id for each in accepted})
    people = find_names(session, (row.account_id for row in decisions.values()))
    numbers = number_registrations(session, {row.moving_scan_id for row in registrations.values()})
    grouped: list[list[Accepted]] = []
    for each in accepted:
        before = grouped[-1][-1] if grouped else None
        continues = before is not None and (each.registration_id, each.decision_id) == (
            before.registration_id,
            before.decision_id,
        )
        if continues:
            grouped[-1].append(each)
        else:
            grouped.append([each])
    stretches = []
    for group in grouped:
        registration, decision = registrations[group[0].registration_id], decisions[group[0].decision_id]
        stretches.append(
            AcceptedStretch(
                first_frame=group[0].frame,
                last_frame=group[-1].frame,
                frame_count=len(group),
                registration_id=registration.id,
                registration_number=numbers[registration.id],
                prior=registration.prior,  # type: ignore[arg-type]  # the table lets no other pass
                job_id=registration.job_id,
                parent_id=registration.parent_id,
                decision_id=decision.id,
                accepted_by_name=people.get(decision.account_id, ""),
                accepted_at=decision.created_at,
            )
        )
    return stretches


def number_registrations(session: Session, moving_scan_ids: set[uuid.UUID]) -> dict[uuid.UUID, int]:
    """The registrations of moving scans counted from 1, the oldest first."""
    query = select(MovingRegistrationRow.moving_scan_id, MovingRegistrationRow.id)
    query = query.where(MovingRegistrationRow.moving_scan_id.in_(moving_scan_ids))
    order = (MovingRegistrationRow.created_at, MovingRegistrationRow.id)
    counts: dict[uuid.UUID, int] = defaultdict(int)
    numbers: dict[uuid.UUID, int] = {}
    for moving_scan_id, id_ in session.execute(query.order_by(*order)):
        counts[moving_scan_id] += 1
        numbers[id_] = counts[moving_scan_id]
    return numbers


def _fetch(session: Session, table, ids: set[uuid.UUID]) -> dict:
    return {row.id: row for row in session.scalars(select(table).where(table.id.in_(ids)))}
