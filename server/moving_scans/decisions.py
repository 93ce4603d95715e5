"""Decisions about stretches of frames: made, taken back, never changed."""

from __future__ import annotations

import uuid
from collections.abc import Callable, Sequence

from sqlalchemy import func, select
from sqlalchemy.exc import IntegrityError
from sqlalchemy.orm import Session

from server.access.service import find_names
from server.errors import ConflictError, ForbiddenError, InvalidError, NotFoundError
from server.moving_scans.decision_schemas import StretchDecisionMake, StretchDecisionOut
from server.moving_scans.models import (
    FrameRegistrationRow,
    MovingRegistrationRow,
    MovingScanRow,
    StretchDecisionRow,
)


def decide(
    session: Session, row: MovingRegistrationRow, account_id: uuid.UUID, made: StretchDecisionMake
) -> tuple[StretchDecisionRow, bool]:
    """Store a decision. Gives it, and whether it is new: a repeated operation is done once."""
    _hold(session, row.moving_scan_id)
    _check_stretch(session, row, made.first_frame, made.last_frame)
    return _add(
        session,
        row,
        StretchDecisionRow(
            account_id=account_id,
            decision=made.decision,
            first_frame=made.first_frame,
            last_frame=made.last_frame,
            note=made.note,
            operation_id=made.operation_id,
        ),
        lambda done: (
            (done.decision, done.first_frame, done.last_frame) == (made.decision, made.first_frame, made.last_frame)
        ),
    )


def undo(
    session: Session, decision_id: uuid.UUID, account_id: uuid.UUID, operation_id: uuid.UUID
) -> tuple[StretchDecisionRow, bool]:
    """Take a decision of one's own back, by a row of its own; what stood before it stands again."""
    decision = session.get(StretchDecisionRow, decision_id)
    if decision is None:
        raise NotFoundError(f"There is no decision {decision_id} about a stretch.")
    _hold(session, decision.moving_scan_id)
    if decision.account_id != account_id:
        raise ForbiddenError(
            "Only its author can undo a decision. Make a decision of your own instead: the last one counts."
        )
    if decision.decision == "undo":
        raise ConflictError("This is an undo already; decide again instead.")
    repeated = select(StretchDecisionRow.operation_id).where(StretchDecisionRow.undoes_id == decision_id)
    if (taken := session.scalar(repeated)) is not None and taken != operation_id:
        raise ConflictError("This decision was already undone.")
    made = StretchDecisionRow(
        account_id=account_id,
        decision="undo",
        undoes_id=decision_id,
        first_frame=decision.first_frame,
        last_frame=decision.last_frame,
        note="",
        operation_id=operation_id,
    )
    row = session.get_one(MovingRegistrationRow, decision.registration_id)
    return _add(session, row, made, lambda done: done.undoes_id == decision_id)


def _hold(session: Session, moving_scan_id: uuid.UUID) -> None:
    """One decision about a moving scan at a time, so that their numbers tell which is the last."""
    session.scalar(select(MovingScanRow.id).where(MovingScanRow.id == moving_scan_id).with_for_update())


def _check_stretch(session: Session, row: MovingRegistrationRow, first: int, last: int) -> None:
    """Nobody accepts what is not there to be looked at."""
    frames = FrameRegistrationRow.frame
    of_it = FrameRegistrationRow.registration_id == row.id
    done = session.scalar(select(func.max(frames)).where(of_it))
    if done is None or last > done or first < row.first_frame:
        there = "none yet" if done is None else f"{row.first_frame} to {done}"
        raise InvalidError(
            f"Frames {first} to {last} are not all registered here; registered are {there}. Choose among these."
        )
    if session.scalar(select(func.count()).where(of_it, frames.between(first, last))) == 0:
        raise InvalidError(f"None of the frames {first} to {last} could be registered. Choose others.")


def _add(
    session: Session,
    row: MovingRegistrationRow,
    made: StretchDecisionRow,
    is_same: Callable[[StretchDecisionRow], bool],
) -> tuple[StretchDecisionRow, bool]:
    """Add a decision, unless the operation was done before."""
    done = session.scalars(
        select(StretchDecisionRow).where(StretchDecisionRow.operation_id == made.operation_id)
    ).one_or_none()
    if done is not None:
        if done.registration_id != row.id or done.account_id != made.account_id or not is_same(done):
            raise _reused(made.operation_id)
        return done, False
    last = select(func.max(StretchDecisionRow.number)).where(StretchDecisionRow.moving_scan_id == row.moving_scan_id)
    made.moving_scan_id, made.registration_id = row.moving_scan_id, row.id
    made.number = (session.scalar(last) or 0) + 1
    try:
        with session.begin_nested():
            session.add(made)
            session.flush()
    except IntegrityError:  # the same operation elsewhere at this very moment
        raise _reused(made.operation_id) from None
    return made, True


def _reused(operation_id: uuid.UUID) -> InvalidError:
    return InvalidError(
        f"The operation {operation_id} belongs to another decision; nothing was stored. Make a new operation_id for "
        "each decision."
    )


def list_decisions(session: Session, moving_scan_id: uuid.UUID) -> Sequence[StretchDecisionRow]:
    """Everything that was decided about a moving scan, in order."""
    query = select(StretchDecisionRow).where(StretchDecisionRow.moving_scan_id == moving_scan_id)
    return session.scalars(query.order_by(StretchDecisionRow.number)).all()


def find_standing(rows: Sequence[StretchDecisionRow]) -> list[StretchDecisionRow]:
    """Those that nobody took back, in their order."""
    undone = {row.undoes_id for row in rows}
    return [row for row in rows if row.decision != "undo" and row.id not in undone]


def describe_decisions(session: Session, rows: Sequence[StretchDecisionRow]) -> list[StretchDecisionOut]:
    """Decisions as the API gives them."""
    undone = set(
        session.scalars(
            select(StretchDecisionRow.undoes_id).where(StretchDecisionRow.undoes_id.in_([row.id for row in rows]))
        )
    )
    people = find_names(session, (row.account_id for row in rows))
    own = StretchDecisionOut.model_fields.keys() - {"author_name", "stands"}
    return [
        StretchDecisionOut.model_validate(
            {name: getattr(row, name) for name in own}
            | {
                "author_name": people.get(row.account_id, ""),
                "stands": row.decision != "undo" and row.id not in undone,
            }
        )
        for row in rows
    ]
