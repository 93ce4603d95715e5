"""How people decide: how fast, and how alike. Second reviews are asked for here."""

from __future__ import annotations

import uuid
from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from datetime import datetime
from itertools import combinations, pairwise

from sqlalchemy import func, select, update
from sqlalchemy.orm import Session

from server.access.service import find_names
from server.registrations.decision_models import DecisionRow
from server.registrations.decision_schemas import (
    PersonThroughput,
    ReviewAgreement,
    ReviewerPair,
    SecondReviewAsk,
    SecondReviewAsked,
    Throughput,
)
from server.registrations.models import RegistrationRow
from server.scans.models import ScanRow

LONGEST_LOOK_S = 60.0
"""A longer pause between two decisions is no work."""

DECISIONS = ("accept", "reject", "unsure")
MOST_DISPUTED = 200
Table = dict[tuple[str, str], int]
"""How often the first and the second person decided so."""


def measure_throughput(session: Session, since: datetime) -> Throughput:
    """What everybody decided since a moment and has not taken back, the busiest first."""
    query = select(DecisionRow).where(DecisionRow.created_at >= since).order_by(DecisionRow.created_at)
    by_person: dict[uuid.UUID, list[DecisionRow]] = defaultdict(list)
    undone: set[uuid.UUID | None] = set()
    for row in session.scalars(query):
        by_person[row.account_id].append(row)
        undone.add(row.undoes_id)
    names = find_names(session, by_person)
    people = [_measure_person(id_, names[id_], rows, undone) for id_, rows in by_person.items()]
    return Throughput(since=since, people=sorted(people, key=lambda person: -person.decisions))


def _measure_person(
    id_: uuid.UUID, name: str, rows: list[DecisionRow], undone: set[uuid.UUID | None]
) -> PersonThroughput:
    kinds = Counter(row.decision for row in rows if row.id not in undone)
    gaps = [(b.created_at - a.created_at).total_seconds() for a, b in pairwise(rows)]
    active = [gap for gap in gaps if gap <= LONGEST_LOOK_S]
    minutes = sum(active) / 60.0
    return PersonThroughput(
        account_id=id_,
        name=name,
        decisions=sum(kinds[kind] for kind in DECISIONS),
        accept=kinds["accept"],
        reject=kinds["reject"],
        unsure=kinds["unsure"],
        undone=kinds["undo"],
        active_minutes=minutes,
        per_minute=len(active) / minutes if minutes > 0 else None,
    )


def ask_second_review(session: Session, asked: SecondReviewAsk) -> SecondReviewAsked:
    """Mark newest registrations for a second person, spread evenly over their ids, which are random."""
    query = (
        select(RegistrationRow.id, RegistrationRow.needs_second)
        .join(ScanRow, ScanRow.id == RegistrationRow.scan_id)
        .where(RegistrationRow.is_current, ScanRow.deleted_at.is_(None), RegistrationRow.reviewer_count < 2)
        .order_by(RegistrationRow.id)
    )
    if asked.collection is not None:
        query = query.where(ScanRow.collection == asked.collection)
    if asked.only_decided:
        query = query.where(RegistrationRow.reviewer_count == 1)
    found = session.execute(query).all()
    count = -int(-len(found) * asked.share // 1)
    already = [id_ for id_, needs in found if needs]
    fresh = [id_ for id_, needs in found if not needs][: max(count - len(already), 0)]
    for first in range(0, len(fresh), 500):
        some = fresh[first : first + 500]
        session.execute(update(RegistrationRow).where(RegistrationRow.id.in_(some)).values(needs_second=True))
    return SecondReviewAsked(marked=len(fresh), already=len(already))


def measure_agreement(session: Session, collection: str | None) -> ReviewAgreement:
    """How alike people decide who could not see each other's decisions."""
    shared = select(RegistrationRow).join(ScanRow, ScanRow.id == RegistrationRow.scan_id)
    waiting = select(func.count()).select_from(RegistrationRow).join(ScanRow, ScanRow.id == RegistrationRow.scan_id)
    waiting = waiting.where(
        RegistrationRow.needs_second, RegistrationRow.reviewer_count < 2, RegistrationRow.is_current
    )
    if collection is not None:
        shared, waiting = (query.where(ScanRow.collection == collection) for query in (shared, waiting))
    rows = session.scalars(shared.where(RegistrationRow.reviewer_count >= 2).order_by(RegistrationRow.id)).all()
    standing = _find_standing(session, rows)
    tables = _count_pairs(standing.values())
    disputed = [id_ for id_, made in standing.items() if len({one.decision for one in made}) > 1]
    names = find_names(session, (id_ for pair in tables for id_ in pair))
    together: Table = sum((Counter(table) for table in tables.values()), Counter())
    both = sum(together.values())
    return ReviewAgreement(
        both=both,
        share_agreed=_share(together) if both else None,
        kappa=compute_kappa(together),
        pairs=[_describe_pair(pair, table, names) for pair, table in tables.items()],
        waiting=session.scalar(waiting) or 0,
        disputed=disputed[:MOST_DISPUTED],
    )


def _find_standing(session: Session, rows: Sequence[RegistrationRow]) -> dict[uuid.UUID, list[DecisionRow]]:
    """The blind decisions about each registration that nobody took back, by the ids of their authors."""
    ids = {row.id for row in rows}
    held = {entry["id"] for row in rows for entry in row.standing.values()}
    standing: dict[uuid.UUID, list[DecisionRow]] = defaultdict(list)
    for made in session.scalars(select(DecisionRow).where(DecisionRow.is_blind).order_by(DecisionRow.number)):
        if made.registration_id in ids and str(made.id) in held:
            standing[made.registration_id].append(made)
    return {id_: sorted(made, key=lambda one: str(one.account_id)) for id_, made in standing.items()}


def _count_pairs(standing: Iterable[list[DecisionRow]]) -> dict[tuple[uuid.UUID, uuid.UUID], Table]:
    """For each two people, how often one decided this and the other that about the same registration."""
    tables: dict[tuple[uuid.UUID, uuid.UUID], Table] = defaultdict(Counter)
    for made in standing:
        for first, second in combinations(made, 2):
            tables[first.account_id, second.account_id][first.decision, second.decision] += 1
    return tables


def _describe_pair(pair: tuple[uuid.UUID, uuid.UUID], table: Table, names: dict[uuid.UUID | None, str]) -> ReviewerPair:
    return ReviewerPair.model_validate(
        {
            "first_id": pair[0],
            "first_name": names[pair[0]],
            "second_id": pair[1],
            "second_name": names[pair[1]],
            "both": sum(table.values()),
            "share_agreed": _share(table),
            "kappa": compute_kappa(table),
            "table": {a: {b: table.get((a, b), 0) for b in DECISIONS} for a in DECISIONS},
        }
    )


def _share(table: Table) -> float:
    return sum(count for (a, b), count in table.items() if a == b) / sum(table.values())


def compute_kappa(table: Table) -> float | None:
    """Cohen's kappa: agreement beyond what chance would give; None where chance alone gives all of it."""
    total = sum(table.values())
    if total == 0:
        return None
    kinds: Iterable[str] = {kind for pair in table for kind in pair}
    by_chance = sum(
        sum(count for (a, _), count in table.items() if a == kind)
        * sum(count for (_, b), count in table.items() if b == kind)
        for kind in kinds
    ) / (total * total)
    return None if by_chance >= 1.0 else (_share(table) - by_chance) / (1.0 - by_chance)
