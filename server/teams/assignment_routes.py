"""`/assignments` and their comments."""

from __future__ import annotations

import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Annotated

from fastapi import APIRouter, Query, Response
from sqlalchemy.orm import Session

from server.access.project_models import AssignmentRow, AssignmentState
from server.access.service import CurrentAccount, LeadAccount, ReviewerAccount
from server.database import SessionDep
from server.database.paging import Cursor, Limit, Page
from server.database.revision import IfMatch, read_if_match, write_etag
from server.errors import ConflictError, error_responses
from server.teams import assignments, comments
from server.teams.schemas import (
    AssignmentMake,
    AssignmentOut,
    AssignmentPatch,
    AssignmentReturn,
    CommentMake,
    CommentOut,
)

router = APIRouter(tags=["assignments"], responses=error_responses(404))
CHANGES = error_responses(409, 428)


@router.get("/assignments")
def list_assignments(
    session: SessionDep,
    account: CurrentAccount,
    mine: Annotated[bool, Query(description="Only those given to whoever asks.")] = False,
    project: Annotated[uuid.UUID | None, Query()] = None,
    sequence: Annotated[uuid.UUID | None, Query()] = None,
    state: Annotated[AssignmentState | None, Query()] = None,
    cursor: Cursor = None,
    limit: Limit = 100,
) -> Page[AssignmentOut]:
    """Assignments of projects at work, the oldest first."""
    wanted = (
        (AssignmentRow.account_id, account.id if mine else None),
        (AssignmentRow.project_id, project),
        (AssignmentRow.sequence_id, sequence),
        (AssignmentRow.state, state),
    )
    conditions = [column == value for column, value in wanted if value is not None]
    rows, next_cursor = assignments.list_assignments(session, conditions, cursor, limit)
    return Page(items=assignments.describe_assignments(session, rows), next_cursor=next_cursor)


@router.post("/projects/{project_id}/assignments", status_code=201, responses=error_responses(409))
def make_assignment(
    project_id: uuid.UUID, body: AssignmentMake, session: SessionDep, account: LeadAccount, response: Response
) -> AssignmentOut:
    """Assign a range of frames to somebody. No frame is assigned to two people."""
    return _answer(session, assignments.make_assignment(session, account, project_id, body), response)


@router.get("/assignments/{assignment_id}")
def get_assignment(
    assignment_id: uuid.UUID, session: SessionDep, account: CurrentAccount, response: Response
) -> AssignmentOut:
    """One assignment."""
    return _answer(session, assignments.get_assignment(session, assignment_id), response)


@router.patch("/assignments/{assignment_id}", responses=CHANGES)
def update_assignment(
    assignment_id: uuid.UUID,
    patch: AssignmentPatch,
    session: SessionDep,
    account: LeadAccount,
    response: Response,
    if_match: IfMatch = None,
) -> AssignmentOut:
    """Give an assignment to somebody else, or change its frames or note."""
    with _held(session, assignment_id, if_match) as row:
        return _answer(session, assignments.update_assignment(session, account, row, patch), response)


@router.delete("/assignments/{assignment_id}", status_code=204, responses=CHANGES)
def withdraw_assignment(
    assignment_id: uuid.UUID, session: SessionDep, account: LeadAccount, if_match: IfMatch = None
) -> None:
    """Withdraw an assignment; `restore` undoes it. The joints stay as they are."""
    with _held(session, assignment_id, if_match) as row:
        assignments.withdraw_assignment(session, account, row, is_withdrawn=True)


@router.post("/assignments/{assignment_id}/restore", responses=error_responses(409))
def restore_assignment(
    assignment_id: uuid.UUID, session: SessionDep, account: LeadAccount, response: Response
) -> AssignmentOut:
    """Undo a withdrawal, if nobody else has the frames meanwhile."""
    row = assignments.get_assignment(session, assignment_id, deleted_too=True)
    assignments.withdraw_assignment(session, account, row, is_withdrawn=False)
    return _answer(session, row, response)


@router.post("/assignments/{assignment_id}/submit", responses=CHANGES)
def submit_assignment(
    assignment_id: uuid.UUID,
    session: SessionDep,
    account: CurrentAccount,
    response: Response,
    if_match: IfMatch = None,
) -> AssignmentOut:
    """Submit the work: from then on its annotations are locked."""
    with _held(session, assignment_id, if_match) as row:
        assignments.submit_assignment(session, account, row)
        return _answer(session, row, response)


@router.post("/assignments/{assignment_id}/accept", responses=CHANGES)
def accept_assignment(
    assignment_id: uuid.UUID,
    session: SessionDep,
    account: ReviewerAccount,
    response: Response,
    if_match: IfMatch = None,
) -> AssignmentOut:
    """Accept submitted work: its annotations are locked for everybody."""
    with _held(session, assignment_id, if_match) as row:
        assignments.accept_assignment(session, account, row)
        return _answer(session, row, response)


@router.post("/assignments/{assignment_id}/return", responses=CHANGES)
def return_assignment(
    assignment_id: uuid.UUID,
    body: AssignmentReturn,
    session: SessionDep,
    account: ReviewerAccount,
    response: Response,
    if_match: IfMatch = None,
) -> AssignmentOut:
    """Send submitted or accepted work back to its annotator, with the reason."""
    with _held(session, assignment_id, if_match) as row:
        assignments.return_assignment(session, account, row, body.text)
        return _answer(session, row, response)


@router.get("/assignments/{assignment_id}/comments")
def list_comments(
    assignment_id: uuid.UUID, session: SessionDep, account: CurrentAccount, cursor: Cursor = None, limit: Limit = 100
) -> Page[CommentOut]:
    """What was said about an assignment, the oldest first; its annotator and reviewers read it."""
    row = assignments.get_assignment(session, assignment_id)
    comments.check_talks(session, account, row)
    rows, next_cursor = comments.list_comments(session, row, cursor, limit)
    return Page(items=comments.describe_comments(session, rows), next_cursor=next_cursor)


@router.post("/assignments/{assignment_id}/comments", status_code=201)
def make_comment(
    assignment_id: uuid.UUID, body: CommentMake, session: SessionDep, account: CurrentAccount
) -> CommentOut:
    """Say something about an assignment, or about a frame, hand or joint in it."""
    row = assignments.get_assignment(session, assignment_id)
    comments.check_talks(session, account, row)
    return comments.describe_comments(session, [comments.make_comment(session, account, row, body)])[0]


@router.post("/assignments/{assignment_id}/comments/{comment_id}/resolve")
def resolve_comment(
    assignment_id: uuid.UUID, comment_id: uuid.UUID, session: SessionDep, account: CurrentAccount
) -> CommentOut:
    """Say that a comment was dealt with."""
    return _resolve(session, account, assignment_id, comment_id, is_resolved=True)


@router.post("/assignments/{assignment_id}/comments/{comment_id}/reopen")
def reopen_comment(
    assignment_id: uuid.UUID, comment_id: uuid.UUID, session: SessionDep, account: CurrentAccount
) -> CommentOut:
    """Say that a comment was not dealt with after all."""
    return _resolve(session, account, assignment_id, comment_id, is_resolved=False)


def _resolve(
    session: Session, account: CurrentAccount, assignment_id: uuid.UUID, comment_id: uuid.UUID, *, is_resolved: bool
) -> CommentOut:
    row = assignments.get_assignment(session, assignment_id)
    comments.check_talks(session, account, row)
    comment = comments.get_comment(session, row, comment_id)
    comments.resolve_comment(session, account, comment, is_resolved=is_resolved)
    return comments.describe_comments(session, [comment])[0]


@contextmanager
def _held(session: Session, assignment_id: uuid.UUID, if_match: str | None) -> Iterator[AssignmentRow]:
    """The assignment, if it is still the revision that is to be changed; else the answer carries how it is now."""
    try:
        yield assignments.get_assignment(session, assignment_id, expected=read_if_match(if_match))
    except assignments.StaleAssignmentError as stale:
        theirs = assignments.describe_assignments(session, [stale.row])[0].model_dump(mode="json")
        raise ConflictError(stale.detail, headers={"ETag": write_etag(stale.row.revision)}, theirs=theirs) from None


def _answer(session: Session, row: AssignmentRow, response: Response) -> AssignmentOut:
    response.headers["ETag"] = write_etag(row.revision)
    return assignments.describe_assignments(session, [row])[0]
