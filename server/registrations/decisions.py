"""Decisions: made, undone, never changed. What counts is computed from all rows at every change."""

from __future__ import annotations

import uuid
from collections.abc import Callable, Sequence

from sqlalchemy import func, select
from sqlalchemy.exc import IntegrityError
from sqlalchemy.orm import Session

from server.access.service import find_names
from server.database.paging import fetch_page
from server.errors import ConflictError, ForbiddenError, InvalidError, NotFoundError
from server.hand_models.models import HandModelRow
from server.registrations.decision_models import DecisionRow
from server.registrations.decision_schemas import DecisionMake, DecisionOut
from server.registrations.models import RegistrationRow
from server.registrations.service import get_registration, is_hidden


def decide(
    session: Session, registration_id: uuid.UUID, account_id: uuid.UUID, made: DecisionMake
) -> tuple[DecisionRow, RegistrationRow, bool]:
    """Store a decision. Gives it, its registration, and whether it is new: a repeated operation is done once."""
    row = get_registration(session, registration_id, hold=True)

    def write(number: int) -> DecisionRow:
        others = [id_ for id_ in row.standing if id_ != str(account_id)]
        return DecisionRow(
            registration_id=row.id,
            account_id=account_id,
            model_id=row.model_id,
            number=number,
            decision=made.decision,
            reasons=made.reasons,
            note=made.note,
            seconds=made.seconds,
            is_blind=not others or is_hidden(row, account_id),
            operation_id=made.operation_id,
        )

    def is_same(done: DecisionRow) -> bool:
        return (done.decision, done.reasons, done.note) == (made.decision, made.reasons, made.note)

    decision, is_new = _add(session, row, account_id, made.operation_id, write, is_same)
    return decision, row, is_new


def undo(
    session: Session, decision_id: uuid.UUID, account_id: uuid.UUID, operation_id: uuid.UUID
) -> tuple[DecisionRow, RegistrationRow, bool]:
    """Take a decision of one's own back, by a row of its own; what stood before it stands again."""
    decision = session.get(DecisionRow, decision_id)
    if decision is None:
        raise NotFoundError(f"There is no decision {decision_id}.")
    row = get_registration(session, decision.registration_id, hold=True)
    if decision.account_id != account_id:
        raise ForbiddenError(
            "Only its author can undo a decision. Make a decision of your own instead: the last one counts."
        )
    if decision.decision == "undo":
        raise ConflictError("This is an undo already; decide again instead.")

    def write(number: int) -> DecisionRow:
        taken = select(DecisionRow.id).where(DecisionRow.undoes_id == decision_id)
        if session.scalar(taken) is not None:
            raise ConflictError("This decision was already undone.")
        return DecisionRow(
            registration_id=row.id,
            account_id=account_id,
            model_id=row.model_id,
            number=number,
            decision="undo",
            undoes_id=decision_id,
            reasons=[],
            note="",
            is_blind=is_hidden(row, account_id),
            operation_id=operation_id,
        )

    made, is_new = _add(session, row, account_id, operation_id, write, lambda done: done.undoes_id == decision_id)
    return made, row, is_new


def _add(
    session: Session,
    row: RegistrationRow,
    account_id: uuid.UUID,
    operation_id: uuid.UUID,
    write: Callable[[int], DecisionRow],
    is_same: Callable[[DecisionRow], bool],
) -> tuple[DecisionRow, bool]:
    """Add a row to those of a registration that is held, unless the operation was done before."""
    done = session.scalars(select(DecisionRow).where(DecisionRow.operation_id == operation_id)).one_or_none()
    if done is not None:
        if done.registration_id != row.id or done.account_id != account_id or not is_same(done):
            raise _reused(operation_id)
        return done, False
    last = select(func.max(DecisionRow.number)).where(DecisionRow.registration_id == row.id)
    made = write((session.scalar(last) or 0) + 1)
    try:
        with session.begin_nested():
            session.add(made)
            session.flush()
    except IntegrityError:  # the same operation on another registration at this very moment
        raise _reused(operation_id) from None
    _count(session, row)
    return made, True


def _reused(operation_id: uuid.UUID) -> InvalidError:
    return InvalidError(
        f"The operation {operation_id} belongs to another decision; nothing was stored. Make a new operation_id for "
        "each decision."
    )


def _count(session: Session, row: RegistrationRow) -> None:
    """Write into a registration what its decisions come to."""
    standing = find_standing(list_history(session, row.id))
    row.standing = {str(made.account_id): {"id": str(made.id), "decision": made.decision} for made in standing}
    row.reviewer_count = len(standing)
    row.sole_reviewer_id = standing[0].account_id if len(standing) == 1 else None
    row.decision = standing[-1].decision if standing else None
    session.flush()


def find_standing(history: Sequence[DecisionRow]) -> list[DecisionRow]:
    """The last decision of each person that was not taken back, in the order they were made."""
    undone = {made.undoes_id for made in history if made.undoes_id is not None}
    last: dict[uuid.UUID, DecisionRow] = {}
    for made in sorted(history, key=lambda made: made.number):
        if made.decision != "undo" and made.id not in undone:
            last[made.account_id] = made
    return sorted(last.values(), key=lambda made: made.number)


def list_history(session: Session, registration_id: uuid.UUID) -> Sequence[DecisionRow]:
    """Every row about a registration, in order."""
    query = select(DecisionRow).where(DecisionRow.registration_id == registration_id)
    return session.scalars(query.order_by(DecisionRow.number)).all()


def list_decisions(
    session: Session,
    author_id: uuid.UUID | None,
    registration_id: uuid.UUID | None,
    reader_id: uuid.UUID,
    cursor: str | None,
    limit: int,
) -> tuple[list[DecisionRow], str | None]:
    """Decisions, the newest first, without those that the reader is to decide about unseen."""
    hidden = (
        RegistrationRow.needs_second
        & (RegistrationRow.reviewer_count == 1)
        & (RegistrationRow.sole_reviewer_id != reader_id)
    )
    query = select(DecisionRow).join(RegistrationRow, RegistrationRow.id == DecisionRow.registration_id)
    query = query.where(~hidden | (DecisionRow.account_id == reader_id))
    if author_id is not None:
        query = query.where(DecisionRow.account_id == author_id)
    if registration_id is not None:
        query = query.where(DecisionRow.registration_id == registration_id)
    return fetch_page(session, query, (DecisionRow.created_at, DecisionRow.id), cursor, limit)


def describe_decisions(session: Session, rows: Sequence[DecisionRow]) -> list[DecisionOut]:
    """Decisions as the API gives them."""
    if not rows:
        return []
    people = find_names(session, (row.account_id for row in rows))
    query = select(HandModelRow.id, HandModelRow.name).where(HandModelRow.id.in_({row.model_id for row in rows}))
    models = {model.id: model.name for model in session.execute(query)}
    about = {row.registration_id for row in rows}
    standing = {
        entry["id"]
        for held in session.scalars(select(RegistrationRow.standing).where(RegistrationRow.id.in_(about)))
        for entry in held.values()
    }
    own = DecisionOut.model_fields.keys() - {"author_name", "model_name", "stands"}
    return [
        DecisionOut.model_validate(
            {name: getattr(row, name) for name in own}
            | {
                "author_name": people.get(row.account_id, ""),
                "model_name": models[row.model_id],
                "stands": str(row.id) in standing,
            }
        )
        for row in rows
    ]
