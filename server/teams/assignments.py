"""Assignments: frames that somebody is to mark, from open to accepted."""

from __future__ import annotations

import uuid
from collections.abc import Sequence

from sqlalchemy import ColumnElement, func, or_, select
from sqlalchemy.orm import Session

from server.access.audit import record_act
from server.access.models import Account
from server.access.project_models import AssignmentRow, AssignmentState, CommentRow, ProjectRow, ReplicaSetRow
from server.access.service import find_names, has_role
from server.database import utc_now
from server.database.paging import fetch_page
from server.errors import ConflictError, ForbiddenError, InvalidError, NotFoundError
from server.sequences.models import SequenceRow
from server.sequences.service import get_sequence
from server.teams import projects
from server.teams.progress import find_progress
from server.teams.schemas import AssignmentMake, AssignmentOut, AssignmentPatch


class StaleAssignmentError(ConflictError):
    """Somebody changed the assignment meanwhile; `row` is how it is now."""

    def __init__(self, row: AssignmentRow) -> None:
        super().__init__(
            f"The assignment was changed meanwhile: it is {row.state} and at revision {row.revision}. Load it again."
        )
        self.row = row


def list_assignments(
    session: Session, conditions: Sequence[ColumnElement[bool]], cursor: str | None, limit: int
) -> tuple[Sequence[AssignmentRow], str | None]:
    """Assignments of projects at work for which all conditions hold, the oldest first."""
    order = (AssignmentRow.created_at, AssignmentRow.id)
    query = (
        select(AssignmentRow)
        .join(ProjectRow, ProjectRow.id == AssignmentRow.project_id)
        .join(SequenceRow, SequenceRow.id == AssignmentRow.sequence_id)
        .where(
            AssignmentRow.deleted_at.is_(None),
            ProjectRow.archived_at.is_(None),
            SequenceRow.deleted_at.is_(None),
            *conditions,
        )
    )
    return fetch_page(session, query, order, cursor, limit, is_falling=False)


def describe_assignments(session: Session, rows: Sequence[AssignmentRow]) -> list[AssignmentOut]:
    """Assignments with their names and how far they are."""
    ids = [row.id for row in rows]
    people = find_names(session, {id_ for row in rows for id_ in (row.account_id, row.reviewer_id)})
    project_names = _names(session, ProjectRow, {row.project_id for row in rows})
    recordings = _names(session, SequenceRow, {row.sequence_id for row in rows})
    set_ids = {row.replica_set_id for row in rows if row.replica_set_id is not None}
    sets = {row.id: row for row in session.scalars(select(ReplicaSetRow).where(ReplicaSetRow.id.in_(set_ids)))}
    comments = dict(
        session.execute(
            select(CommentRow.assignment_id, func.count())
            .where(CommentRow.assignment_id.in_(ids), CommentRow.resolved_at.is_(None))
            .group_by(CommentRow.assignment_id)
        ).all()
    )
    progress = find_progress(session, rows, sets)
    return [
        AssignmentOut(
            id=row.id,
            project_id=row.project_id,
            project=project_names[row.project_id],
            sequence_id=row.sequence_id,
            recording=recordings[row.sequence_id],
            account_id=row.account_id,
            account=people[row.account_id],
            replica_set_id=row.replica_set_id,
            replica_set=sets[row.replica_set_id].name if row.replica_set_id else None,
            frame_first=row.frame_first,
            frame_last=row.frame_last,
            frames=progress[row.id].frames,
            frames_done=progress[row.id].done,
            frames_partial=progress[row.id].partial,
            next_frame=progress[row.id].next_frame,
            state=row.state,
            note=row.note,
            open_comments=comments.get(row.id, 0),
            revision=row.revision,
            created_at=row.created_at,
            updated_at=row.updated_at,
            reviewer=people.get(row.reviewer_id),
        )
        for row in rows
    ]


def _names(session: Session, table: type[ProjectRow] | type[SequenceRow], ids: set[uuid.UUID]) -> dict[uuid.UUID, str]:
    return dict(session.execute(select(table.id, table.name).where(table.id.in_(ids))).all())


def get_assignment(
    session: Session, id_: uuid.UUID, *, expected: int | None = None, deleted_too: bool = False
) -> AssignmentRow:
    """The assignment of this id; with `expected`, to be changed: it must still be that revision, and is held."""
    query = select(AssignmentRow).where(AssignmentRow.id == id_)
    if expected is not None or deleted_too:
        query = query.with_for_update().execution_options(populate_existing=True)
    row = session.scalars(query).one_or_none()
    if row is None or (row.deleted_at is not None and not deleted_too):
        gone = "was withdrawn; a lead can restore it" if row is not None else "does not exist"
        raise NotFoundError(f"The assignment {id_} {gone}.")
    if expected is not None and row.revision != expected:
        raise StaleAssignmentError(row)
    return row


def make_assignment(session: Session, account: Account, project_id: uuid.UUID, body: AssignmentMake) -> AssignmentRow:
    """Give somebody a range of frames."""
    project = projects.get_project(session, project_id, working=True)
    sequence = get_sequence(session, body.sequence_id)
    projects.check_membership(session, project, sequence)
    check_worker(session, body.account_id)
    row = AssignmentRow(
        id=uuid.uuid4(),
        project_id=project.id,
        sequence_id=sequence.id,
        account_id=body.account_id,
        frame_first=body.frame_first,
        frame_last=body.frame_last,
        note=body.note,
        state="open",
        created_by=account.id,
    )
    _check_frames(session, sequence, row)
    session.add(row)
    session.flush()
    record_act(session, account.id, "assignment.create", "assignment", row.id, **_facts(row))
    return row


def update_assignment(session: Session, account: Account, row: AssignmentRow, patch: AssignmentPatch) -> AssignmentRow:
    """Give an assignment to somebody else, or change its frames or note."""
    changes = {name: value for name, value in patch.model_dump(exclude_unset=True).items() if value is not None}
    if changes.keys() - {"note"}:
        if row.replica_set_id is not None:
            raise ConflictError("The frames of a blind replica and its annotator stay. Withdraw it and make another.")
        if row.state in ("submitted", "accepted"):
            raise ConflictError(f"The assignment is {row.state}. Return it before its frames or annotator change.")
    if "account_id" in changes:
        check_worker(session, changes["account_id"])
    sequence = get_sequence(session, row.sequence_id)  # before the row changes: a query would write frames unchecked
    for name, value in changes.items():
        setattr(row, name, value)
    if {"frame_first", "frame_last"} & changes.keys():
        _check_frames(session, sequence, row)
    _touch(session, row)
    record_act(session, account.id, "assignment.update", "assignment", row.id, **_facts(row))
    return row


def withdraw_assignment(session: Session, account: Account, row: AssignmentRow, *, is_withdrawn: bool) -> None:
    """Take an assignment back, or undo that. The joints stay as they are."""
    if (row.deleted_at is not None) == is_withdrawn:
        return
    if not is_withdrawn and row.replica_set_id is None:
        _check_frames(session, get_sequence(session, row.sequence_id), row)
    row.deleted_at = utc_now() if is_withdrawn else None
    _touch(session, row)
    act = "assignment.withdraw" if is_withdrawn else "assignment.restore"
    record_act(session, account.id, act, "assignment", row.id, **_facts(row))


def submit_assignment(session: Session, account: Account, row: AssignmentRow) -> None:
    """The annotator says that the work is done: it is locked until its review."""
    if row.account_id != account.id and not has_role(account, "lead"):
        raise ForbiddenError("Only its annotator, or a lead, submits an assignment.")
    _go(session, account, row, "submitted", "assignment.submit", after=("open", "returned"))


def accept_assignment(session: Session, account: Account, row: AssignmentRow) -> None:
    """A reviewer finds the work good: it is locked for everybody."""
    _check_reviewer(account, row)
    row.reviewer_id = account.id
    _go(session, account, row, "accepted", "assignment.accept", after=("submitted",))


def return_assignment(session: Session, account: Account, row: AssignmentRow, text: str) -> None:
    """A reviewer wants changes and says which."""
    _check_reviewer(account, row)
    query = select(CommentRow.id).where(CommentRow.assignment_id == row.id, CommentRow.resolved_at.is_(None))
    if not text and session.scalar(query.limit(1)) is None:
        raise InvalidError("Say what should be changed: send a text, or comment on frames first.")
    row.reviewer_id = account.id
    _go(session, account, row, "returned", "assignment.return", after=("submitted", "accepted"))
    if text:
        session.add(CommentRow(assignment_id=row.id, account_id=account.id, text=text))
        session.flush()


def check_worker(session: Session, account_id: uuid.UUID) -> Account:
    """The account that work is given to, if it can work."""
    worker = session.get(Account, account_id)
    if worker is None or worker.disabled_at is not None:
        gone = "is disabled" if worker is not None else "does not exist"
        raise InvalidError(f"The account {account_id} {gone}. Choose one of /people.")
    return worker


def _check_reviewer(account: Account, row: AssignmentRow) -> None:
    if row.account_id == account.id and not has_role(account, "lead"):
        raise ForbiddenError("Nobody reviews their own work; only a lead may. Ask another reviewer.")


def _go(
    session: Session,
    account: Account,
    row: AssignmentRow,
    state: AssignmentState,
    act: str,
    after: tuple[AssignmentState, ...],
) -> None:
    if row.state not in after:
        raise ConflictError(f"The assignment is {row.state}; it must be {' or '.join(after)} to become {state}.")
    before, row.state = row.state, state
    _touch(session, row)
    record_act(session, account.id, act, "assignment", row.id, before=before, **_facts(row))


def _touch(session: Session, row: AssignmentRow) -> None:
    row.revision += 1
    row.updated_at = utc_now()
    session.flush()


def _facts(row: AssignmentRow) -> dict[str, object]:
    return {
        "given_to": str(row.account_id),
        "sequence_id": str(row.sequence_id),
        "frames": [row.frame_first, row.frame_last],
        "state": row.state,
    }


def _check_frames(session: Session, sequence: SequenceRow, row: AssignmentRow) -> None:
    """The frames are in the recording and nobody else has them. Holds the recording: two leads come one by one."""
    first, last = row.frame_first, row.frame_last
    if not 0 <= first <= last < sequence.frame_count:
        raise InvalidError(
            f"Frames {first} to {last} are not valid in {sequence.name}: give a first and a last one between 0 and "
            f"{sequence.frame_count - 1}."
        )
    session.execute(select(SequenceRow.id).where(SequenceRow.id == sequence.id).with_for_update())
    with session.no_autoflush:
        query = (
            select(AssignmentRow)
            .join(ProjectRow, ProjectRow.id == AssignmentRow.project_id)
            .where(
                AssignmentRow.id != row.id,
                AssignmentRow.sequence_id == sequence.id,
                AssignmentRow.replica_set_id.is_(None),
                AssignmentRow.deleted_at.is_(None),
                or_(ProjectRow.archived_at.is_(None), AssignmentRow.state == "accepted"),
                AssignmentRow.frame_first <= last,
                AssignmentRow.frame_last >= first,
            )
        )
        other = session.scalars(query.limit(1)).first()
    if other is not None:
        name = find_names(session, [other.account_id]).get(other.account_id)
        raise ConflictError(
            f"Frames {other.frame_first} to {other.frame_last} of {sequence.name} are {name}'s already. Choose others, "
            "or withdraw that assignment."
        )
