"""Who may read and change which annotations: submitted work is locked, others' work is theirs, replicas stay blind."""

from __future__ import annotations

import uuid
from collections.abc import Sequence
from typing import Any

from sqlalchemy import and_, bindparam, or_, select
from sqlalchemy.orm import Session

from server.access.models import Account
from server.access.places import HiddenPlaces, Place
from server.access.project_models import AssignmentRow, ProjectRow, ReplicaSetRow
from server.access.service import find_names, has_role
from server.database import Base
from server.errors import ForbiddenError, NotFoundError


class LockedError(ForbiddenError):
    """The frame belongs to work that was handed in."""


class NotYoursError(ForbiddenError):
    """The frame was given to somebody else."""


def check_change(session: Session, account: Account, place: Place) -> None:
    """Raise when the account must not change the place.

    The assignments are held (PostgreSQL: FOR SHARE; SQLite writes one at a time) until the change is stored, so that
    nothing slips in after a submission.
    """
    if place.replica:
        _check_replica_change(session, account, place)
    else:
        _check_shared_change(session, account, place)


def _check_replica_change(session: Session, account: Account, place: Place) -> None:
    assignment, replicas = _get_replica(session, place.sequence_id, place.replica, hold=True)
    if assignment.account_id != account.id:
        raise NotYoursError("A blind replica is changed by its own annotator only.")
    if assignment.state in ("submitted", "accepted"):
        raise LockedError(
            f"You have submitted these frames of {replicas.name}. A reviewer can return them to you for changes."
        )
    if place not in _places(replicas):
        raise NotFoundError(
            f"{replicas.name} does not have {place}; it has {len(replicas.frames)} frames of {replicas.cameras}, "
            f"hands {replicas.hands}."
        )


_ASSIGNMENTS, _SETS, _PROJECTS = (
    Base.metadata.tables[row.__tablename__] for row in (AssignmentRow, ReplicaSetRow, ProjectRow)
)
_GIVEN, _SET = _ASSIGNMENTS.c, _SETS.c
_CONCERNED = (
    select(
        *(_GIVEN.account_id, _GIVEN.state, _GIVEN.replica_set_id, _PROJECTS.c.archived_at),
        *(_SET.frames, _SET.cameras, _SET.hands, _SET.deleted_at),
    )
    .select_from(_ASSIGNMENTS)
    .join(_PROJECTS, _PROJECTS.c.id == _GIVEN.project_id)
    .outerjoin(_SETS, _SET.id == _GIVEN.replica_set_id)
    .where(
        _GIVEN.sequence_id == bindparam("sequence"),
        _GIVEN.deleted_at.is_(None),
        or_(
            and_(
                _GIVEN.replica_set_id.is_(None),
                _GIVEN.frame_first <= bindparam("frame"),
                _GIVEN.frame_last >= bindparam("frame"),
            ),
            and_(
                _GIVEN.replica_set_id.is_not(None),
                _GIVEN.account_id == bindparam("account"),
                _GIVEN.state != "accepted",
            ),
        ),
    )
    .with_for_update(read=True, of=_ASSIGNMENTS)
)
"""The assignments that a frame is in, and those in which somebody marks frames of its recording blindly."""


def _check_shared_change(session: Session, account: Account, place: Place) -> None:
    where = {"sequence": place.sequence_id, "frame": place.frame, "account": account.id}
    concerned = session.execute(_CONCERNED, where).all()
    if any(_is_blind_at(row, place) for row in concerned):
        raise ForbiddenError(f"You mark {place} blindly: open your replica instead of everybody's annotations.")
    found = [row for row in concerned if row.replica_set_id is None]
    if any(row.state == "accepted" for row in found):
        raise LockedError(
            f"Frame {place.frame} is finished: its assignment was accepted. A reviewer can return it for changes."
        )
    live = [row for row in found if row.archived_at is None]
    if not live or has_role(account, "reviewer"):
        return
    if any(row.state == "submitted" for row in live):
        raise LockedError(
            f"Frame {place.frame} was submitted and waits for its review. A reviewer can return it for changes."
        )
    if all(row.account_id != account.id for row in live):
        names = find_names(session, [row.account_id for row in live])
        raise NotYoursError(
            f"Frame {place.frame} is assigned to {', '.join(sorted(names.values()))}. Ask a lead to assign it to you."
        )


def _is_blind_at(row: Any, place: Place) -> bool:
    is_open = row.replica_set_id is not None and row.archived_at is None and row.deleted_at is None
    return is_open and place in _places(row)


def find_hidden(session: Session, account: Account, sequence_id: uuid.UUID, replica: str = "") -> list[HiddenPlaces]:
    """Places of a recording that the account must not read: those it marks blindly itself.

    With a replica, those of that one; raises when it is somebody else's. Empty is what everybody sees.
    """
    if replica:
        check_replica_read(session, account, *_get_replica(session, sequence_id, replica))
        return []
    return [_places(replicas) for replicas in _find_blind_sets(session, account, sequence_id)]


def check_read(session: Session, account: Account, place: Place) -> None:
    """Raise when the account must not read the place."""
    if any(place in hidden for hidden in find_hidden(session, account, place.sequence_id, place.replica)):
        raise ForbiddenError(
            f"You mark {place} blindly, so nobody else's joints are shown to you there until your work is accepted."
        )


def check_replica_read(session: Session, account: Account, assignment: AssignmentRow, replicas: ReplicaSetRow) -> None:
    """Raise unless the replica is the account's, or was handed in and the account may review it."""
    if assignment.account_id == account.id:
        return
    if not has_role(account, "reviewer"):
        raise ForbiddenError("A blind replica is shown to its annotator and to reviewers only.")
    check_sees_set(session, account, replicas)
    if assignment.state not in ("submitted", "accepted"):
        raise ForbiddenError("This blind replica is being marked; reviewers see it when it was submitted.")


def check_sees_set(session: Session, account: Account, replicas: ReplicaSetRow) -> None:
    """Raise when the account marks this set itself and is not done with it."""
    query = select(AssignmentRow.id).where(
        AssignmentRow.replica_set_id == replicas.id,
        AssignmentRow.account_id == account.id,
        AssignmentRow.deleted_at.is_(None),
        AssignmentRow.state != "accepted",
    )
    if session.scalar(query.limit(1)) is not None:
        raise ForbiddenError(
            f"You mark {replicas.name} blindly yourself: what others marked is shown to you when your work is accepted."
        )


def check_sees_tracks(session: Session, account: Account, sequence_id: uuid.UUID) -> None:
    """Raise when the account marks frames of the recording blindly: tracks and evaluations show where joints are."""
    if names := [replicas.name for replicas in _find_blind_sets(session, account, sequence_id)]:
        raise ForbiddenError(
            f"You mark frames of this recording blindly ({', '.join(sorted(set(names)))}). Its tracks and evaluations "
            "are shown to you when your work is accepted."
        )


def _get_replica(
    session: Session, sequence_id: uuid.UUID, replica: str, hold: bool = False
) -> tuple[AssignmentRow, ReplicaSetRow]:
    query = (
        select(AssignmentRow, ReplicaSetRow)
        .join(ReplicaSetRow, ReplicaSetRow.id == AssignmentRow.replica_set_id)
        .join(ProjectRow, ProjectRow.id == AssignmentRow.project_id)
        .where(
            AssignmentRow.id == uuid.UUID(replica),
            AssignmentRow.sequence_id == sequence_id,
            AssignmentRow.deleted_at.is_(None),
            ReplicaSetRow.deleted_at.is_(None),
            ProjectRow.archived_at.is_(None),
        )
    )
    if hold:
        query = query.with_for_update(read=True, of=AssignmentRow)
    found = session.execute(query).one_or_none()
    if found is None:
        raise NotFoundError(f"The recording has no blind replica {replica}, or no longer.")
    return found


_BLIND = (
    select(_SET.name, _SET.frames, _SET.cameras, _SET.hands)
    .select_from(_SETS)
    .join(_ASSIGNMENTS, _GIVEN.replica_set_id == _SET.id)
    .join(_PROJECTS, _PROJECTS.c.id == _GIVEN.project_id)
    .where(
        _GIVEN.account_id == bindparam("account"),
        _GIVEN.sequence_id == bindparam("sequence"),
        _GIVEN.state != "accepted",
        _GIVEN.deleted_at.is_(None),
        _SET.deleted_at.is_(None),
        _PROJECTS.c.archived_at.is_(None),
    )
)
"""The replica sets of a recording that somebody marks and is not done with."""


def _find_blind_sets(session: Session, account: Account, sequence_id: uuid.UUID) -> Sequence[Any]:
    return session.execute(_BLIND, {"account": account.id, "sequence": sequence_id}).all()


def _places(replicas: Any) -> HiddenPlaces:
    return HiddenPlaces(frozenset(replicas.frames), frozenset(replicas.cameras), frozenset(replicas.hands))
