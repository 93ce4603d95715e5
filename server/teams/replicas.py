"""Replica sets: frames that several people mark without seeing each other's joints."""

from __future__ import annotations

import uuid
from collections.abc import Sequence

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from server.access.audit import record_act
from server.access.models import Account
from server.access.project_models import AssignmentRow, ProjectRow, ReplicaSetRow
from server.annotations.service import check_place
from server.database import utc_now
from server.database.paging import fetch_page
from server.errors import ConflictError, InvalidError, NotFoundError
from server.sequences.models import SequenceRow
from server.sequences.service import get_sequence
from server.teams import projects
from server.teams.assignments import check_worker
from server.teams.schemas import ReplicaSetMake, ReplicaSetOut


def list_replica_sets(
    session: Session, project: ProjectRow, cursor: str | None, limit: int
) -> tuple[Sequence[ReplicaSetRow], str | None]:
    """Replica sets of a project, the newest first."""
    order = (ReplicaSetRow.created_at, ReplicaSetRow.id)
    query = select(ReplicaSetRow).where(ReplicaSetRow.project_id == project.id, ReplicaSetRow.deleted_at.is_(None))
    return fetch_page(session, query, order, cursor, limit)


def describe_replica_sets(session: Session, rows: Sequence[ReplicaSetRow]) -> list[ReplicaSetOut]:
    """Replica sets with how many of their annotators are done."""
    states: dict[uuid.UUID, dict[str, int]] = {row.id: {} for row in rows}
    query = (
        select(AssignmentRow.replica_set_id, AssignmentRow.state, func.count())
        .where(AssignmentRow.replica_set_id.in_(states), AssignmentRow.deleted_at.is_(None))
        .group_by(AssignmentRow.replica_set_id, AssignmentRow.state)
    )
    for id_, state, count in session.execute(query):
        if id_ is not None:
            states[id_][state] = count
    names = dict(
        session.execute(
            select(SequenceRow.id, SequenceRow.name).where(SequenceRow.id.in_({row.sequence_id for row in rows}))
        ).all()
    )
    return [
        ReplicaSetOut.model_validate(
            {
                "id": row.id,
                "project_id": row.project_id,
                "sequence_id": row.sequence_id,
                "recording": names[row.sequence_id],
                "name": row.name,
                "frames": row.frames,
                "cameras": row.cameras,
                "hands": row.hands,
                "annotators": sum(states[row.id].values()),
                "finished": states[row.id].get("submitted", 0) + states[row.id].get("accepted", 0),
                "created_at": row.created_at,
            }
        )
        for row in rows
    ]


def get_replica_set(
    session: Session, id_: uuid.UUID, *, hold: bool = False, deleted_too: bool = False
) -> ReplicaSetRow:
    """The replica set of this id."""
    query = select(ReplicaSetRow).where(ReplicaSetRow.id == id_)
    if hold:
        query = query.with_for_update().execution_options(populate_existing=True)
    row = session.scalars(query).one_or_none()
    if row is None or (row.deleted_at is not None and not deleted_too):
        gone = "was withdrawn; a lead can restore it" if row is not None else "does not exist"
        raise NotFoundError(f"The replica set {id_} {gone}.")
    return row


def make_replica_set(session: Session, account: Account, project_id: uuid.UUID, body: ReplicaSetMake) -> ReplicaSetRow:
    """Give the same frames to several people, each with an assignment of their own."""
    project = projects.get_project(session, project_id, working=True)
    sequence = get_sequence(session, body.sequence_id)
    projects.check_membership(session, project, sequence)
    for values, what in (
        (body.frames, "frame"),
        (body.cameras, "camera"),
        (body.hands, "hand"),
        (body.account_ids, "account"),
    ):
        if len(set(values)) != len(values):
            raise InvalidError(f"Name each {what} once.")
    for camera in body.cameras:
        check_place(sequence, camera, 0, body.hands[0])
    check_place(sequence, body.cameras[0], max(body.frames), body.hands[0])
    row = ReplicaSetRow(
        id=uuid.uuid4(),
        project_id=project.id,
        sequence_id=sequence.id,
        name=body.name,
        frames=sorted(body.frames),
        cameras=body.cameras,
        hands=body.hands,
        created_by=account.id,
    )
    session.add(row)
    session.flush()
    record_act(session, account.id, "replica_set.create", "replica_set", row.id, name=row.name, frames=len(row.frames))
    for account_id in body.account_ids:
        add_annotator(session, account, row, account_id, body.note)
    return row


def add_annotator(
    session: Session, account: Account, row: ReplicaSetRow, account_id: uuid.UUID, note: str = ""
) -> AssignmentRow:
    """Give a replica set to one more person."""
    check_worker(session, account_id)
    query = select(AssignmentRow.id).where(
        AssignmentRow.replica_set_id == row.id,
        AssignmentRow.account_id == account_id,
        AssignmentRow.deleted_at.is_(None),
    )
    if session.scalar(query.limit(1)) is not None:
        raise ConflictError(f"The account {account_id} marks {row.name} already.")
    made = AssignmentRow(
        id=uuid.uuid4(),
        project_id=row.project_id,
        sequence_id=row.sequence_id,
        account_id=account_id,
        replica_set_id=row.id,
        frame_first=row.frames[0],
        frame_last=row.frames[-1],
        note=note,
        state="open",
        created_by=account.id,
    )
    session.add(made)
    session.flush()
    detail = {"given_to": str(account_id), "replica_set_id": str(row.id)}
    record_act(session, account.id, "assignment.create", "assignment", made.id, **detail)
    return made


def withdraw_replica_set(session: Session, account: Account, row: ReplicaSetRow, *, is_withdrawn: bool) -> None:
    """Take a replica set back with its assignments, or undo that. What was marked stays stored."""
    if (row.deleted_at is not None) == is_withdrawn:
        return
    before, row.deleted_at = row.deleted_at, utc_now() if is_withdrawn else None
    query = select(AssignmentRow).where(AssignmentRow.replica_set_id == row.id).with_for_update()
    for assignment in session.scalars(query).all():
        if assignment.deleted_at == (None if is_withdrawn else before):
            assignment.deleted_at = row.deleted_at
            assignment.revision += 1
    session.flush()
    act = "replica_set.withdraw" if is_withdrawn else "replica_set.restore"
    record_act(session, account.id, act, "replica_set", row.id, name=row.name)
