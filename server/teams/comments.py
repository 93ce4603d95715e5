"""Comments: what reviewers and annotators say to each other about places in an assignment."""

from __future__ import annotations

import uuid
from collections.abc import Sequence

from sqlalchemy import select
from sqlalchemy.orm import Session

from server.access.audit import record_act
from server.access.models import Account
from server.access.policy import check_sees_set
from server.access.project_models import AssignmentRow, CommentRow, ReplicaSetRow
from server.access.service import find_names, has_role
from server.annotations.service import check_place
from server.database import utc_now
from server.database.paging import fetch_page
from server.errors import ForbiddenError, InvalidError, NotFoundError
from server.sequences.service import get_sequence
from server.teams.schemas import CommentMake, CommentOut


def check_talks(session: Session, account: Account, row: AssignmentRow) -> None:
    """Raise unless the account is the assignment's annotator or may review it."""
    if row.account_id == account.id:
        return
    if not has_role(account, "reviewer"):
        raise ForbiddenError("Comments are between an annotator and the reviewers; this is somebody else's work.")
    if row.replica_set_id is not None:
        replicas = session.get(ReplicaSetRow, row.replica_set_id)
        assert replicas is not None, "a foreign key"
        check_sees_set(session, account, replicas)


def list_comments(
    session: Session, row: AssignmentRow, cursor: str | None, limit: int
) -> tuple[Sequence[CommentRow], str | None]:
    """Comments on an assignment, the oldest first."""
    order = (CommentRow.created_at, CommentRow.id)
    query = select(CommentRow).where(CommentRow.assignment_id == row.id)
    return fetch_page(session, query, order, cursor, limit, is_falling=False)


def make_comment(session: Session, account: Account, row: AssignmentRow, body: CommentMake) -> CommentRow:
    """Say something about an assignment, or about a place in it."""
    if body.frame is not None and not row.frame_first <= body.frame <= row.frame_last:
        raise InvalidError(
            f"Frame {body.frame} is not in this assignment, which goes from {row.frame_first} to {row.frame_last}."
        )
    if body.camera is not None:
        sequence = get_sequence(session, row.sequence_id)
        check_place(sequence, body.camera, body.frame or 0, body.hand or "right")
    made = CommentRow(assignment_id=row.id, account_id=account.id, **body.model_dump())
    session.add(made)
    session.flush()
    record_act(session, account.id, "comment.create", "assignment", row.id, comment_id=str(made.id), frame=body.frame)
    return made


def get_comment(session: Session, row: AssignmentRow, comment_id: uuid.UUID) -> CommentRow:
    """A comment on this assignment."""
    comment = session.get(CommentRow, comment_id)
    if comment is None or comment.assignment_id != row.id:
        raise NotFoundError(f"The assignment has no comment {comment_id}.")
    return comment


def resolve_comment(session: Session, account: Account, comment: CommentRow, *, is_resolved: bool) -> None:
    """Say that a comment was dealt with, or that it was not; nothing happens when it is so."""
    if (comment.resolved_at is not None) == is_resolved:
        return
    comment.resolved_at = utc_now() if is_resolved else None
    comment.resolved_by = account.id if is_resolved else None
    session.flush()
    act = "comment.resolve" if is_resolved else "comment.reopen"
    record_act(session, account.id, act, "assignment", comment.assignment_id, comment_id=str(comment.id))


def describe_comments(session: Session, rows: Sequence[CommentRow]) -> list[CommentOut]:
    """Comments with names."""
    names = find_names(session, {id_ for row in rows for id_ in (row.account_id, row.resolved_by)})
    fields = CommentOut.model_fields.keys() - {"author", "resolved_by"}
    return [
        CommentOut.model_validate(
            {field: getattr(row, field) for field in fields}
            | {"author": names.get(row.account_id), "resolved_by": names.get(row.resolved_by)}
        )
        for row in rows
    ]
