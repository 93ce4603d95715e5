"""Comments on work: who may talk, about which places, and that a thing dealt with is said once."""

from __future__ import annotations

import uuid
from collections.abc import Iterator

import pytest
from sqlalchemy import select

from server.access.audit import AuditRow
from server.database import Database
from server.errors import ForbiddenError, InvalidError, NotFoundError
from server.teams.comments import (
    check_talks,
    describe_comments,
    get_comment,
    list_comments,
    make_comment,
    resolve_comment,
)
from server.teams.schemas import CommentMake
from tests.server.teams.rows import Work


@pytest.fixture
def database_kind() -> str:
    """One will do: what is asked here are plain queries."""
    return "sqlite"


@pytest.fixture
def work(database: Database) -> Iterator[Work]:
    with database.writing() as session:
        yield Work(session)


def acts(work: Work) -> list[str]:
    return list(work.session.scalars(select(AuditRow.act).order_by(AuditRow.time, AuditRow.id)))


def test_the_annotator_and_reviewers_talk_and_a_colleague_does_not(work: Work) -> None:
    ann = work.join("ann")
    row = work.assign(ann)
    check_talks(work.session, ann, row)
    check_talks(work.session, work.join("rob", "reviewer"), row)
    with pytest.raises(ForbiddenError, match="between an annotator and the reviewers; this is somebody else's work"):
        check_talks(work.session, work.join("bob"), row)


def test_a_reviewer_who_marks_the_same_set_blindly_does_not_talk_about_it(work: Work) -> None:
    ann, rob = work.join("ann"), work.join("rob", "reviewer")
    replicas = work.replicate("Week 1", [3, 4])
    theirs = work.assign(ann, replica_set_id=replicas.id)
    check_talks(work.session, rob, theirs)
    mine = work.assign(rob, replica_set_id=replicas.id)
    with pytest.raises(ForbiddenError, match="Week 1"):
        check_talks(work.session, rob, theirs)
    check_talks(work.session, rob, mine)


@pytest.mark.parametrize("frame", [3, 8])
def test_the_first_and_the_last_frame_of_the_work_can_be_spoken_of(work: Work, frame: int) -> None:
    ann = work.join("ann")
    made = make_comment(work.session, ann, work.assign(ann), CommentMake(text="here", frame=frame, camera="cam1"))
    assert (made.text, made.frame, made.camera, made.account_id) == ("here", frame, "cam1", ann.id)


@pytest.mark.parametrize("frame", [2, 9])
def test_a_frame_beside_the_work_is_refused_with_the_frames_that_are_in_it(work: Work, frame: int) -> None:
    ann = work.join("ann")
    with pytest.raises(InvalidError, match=f"Frame {frame} is not in this assignment, which goes from 3 to 8"):
        make_comment(work.session, ann, work.assign(ann), CommentMake(text="here", frame=frame))
    assert acts(work) == []


def test_a_camera_that_the_recording_does_not_have_is_refused_with_those_it_has(work: Work) -> None:
    ann = work.join("ann")
    with pytest.raises(NotFoundError, match=r"waving has no camera 'cam7'; it has \['cam0', 'cam1'\]"):
        make_comment(work.session, ann, work.assign(ann), CommentMake(text="here", frame=4, camera="cam7"))


def test_comments_come_oldest_first_in_pages_and_each_work_has_its_own(work: Work) -> None:
    ann = work.join("ann")
    row, other = work.assign(ann), work.assign(ann, 10, 12)
    made = [make_comment(work.session, ann, row, CommentMake(text=f"{number}")).id for number in range(5)]
    make_comment(work.session, ann, other, CommentMake(text="elsewhere"))
    seen, cursor = [], None
    for _ in range(3):
        page, cursor = list_comments(work.session, row, cursor, 2)
        seen += [comment.id for comment in page]
    assert seen == made and cursor is None


def test_a_comment_is_found_with_its_own_work_only(work: Work) -> None:
    ann = work.join("ann")
    row, other = work.assign(ann), work.assign(ann, 10, 12)
    made = make_comment(work.session, ann, row, CommentMake(text="here"))
    assert get_comment(work.session, row, made.id) is made
    for assignment, id_ in ((other, made.id), (row, uuid.uuid4())):
        with pytest.raises(NotFoundError, match=f"The assignment has no comment {id_}"):
            get_comment(work.session, assignment, id_)


def test_what_was_dealt_with_is_said_once_with_who_did_and_can_be_taken_back(work: Work) -> None:
    ann, rob = work.join("ann"), work.join("rob", "reviewer")
    made = make_comment(work.session, ann, work.assign(ann), CommentMake(text="here", frame=4))
    resolve_comment(work.session, ann, made, is_resolved=False)
    assert acts(work) == ["comment.create"], "it was open already"
    resolve_comment(work.session, rob, made, is_resolved=True)
    at = made.resolved_at
    resolve_comment(work.session, ann, made, is_resolved=True)
    assert (made.resolved_at, made.resolved_by) == (at, rob.id), "who dealt with it first stays named"
    [told] = describe_comments(work.session, [made])
    assert (told.author, told.resolved_by, told.frame) == ("ann", "rob", 4)
    resolve_comment(work.session, ann, made, is_resolved=False)
    [told] = describe_comments(work.session, [made])
    assert (told.resolved_at, told.resolved_by) == (None, None)
    assert acts(work) == ["comment.create", "comment.resolve", "comment.reopen"]


def test_no_comments_are_described_as_none(work: Work) -> None:
    assert describe_comments(work.session, []) == []
