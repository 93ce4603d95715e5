"""Changes of annotations. Fifty people who click make one a second each, so a change is four plain statements.

One looks up all that there is at the place, one what the assignments say (`access/policy.py`), two store the change.
They are written once: to put them together anew, and to keep the rows as objects, took longer than the database.
"""

from __future__ import annotations

import uuid
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any, cast

from sqlalchemy import CursorResult, and_, bindparam, insert, select, update
from sqlalchemy.exc import IntegrityError
from sqlalchemy.orm import Session

from server.access.models import Account
from server.access.places import Place
from server.annotations.models import Act, AnnotationRevisionRow, AnnotationRow
from server.annotations.service import Extent, check_place, check_points
from server.annotations.sources import count_decided, imported_sources, settle_sources, write_sources
from server.database import Base, utc_now
from server.errors import ConflictError, InvalidError, NotFoundError
from server.sequences.models import SequenceRow
from server.sequences.service import get_sequence
from tracker import Annotations


@dataclass(frozen=True)
class Change:
    """What somebody wants to do.

    Attributes:
        act: For the history.
        points: 21 times [x, y, v], or None to delete.
        expected: Revision that is changed; None: there must be none yet.
        operation_id: The client's.
        account_id: Who.
        sources: Of each joint what was accepted there; None: as `carry_sources` has it.
    """

    act: Act
    points: Sequence[Sequence[float]] | None
    expected: int | None
    operation_id: uuid.UUID
    account_id: uuid.UUID
    sources: list[Any] | None = None


@dataclass(frozen=True)
class Marked:
    """An annotation as one revision made it.

    Attributes:
        points: None when it was deleted.
        author: Name of who made it, as far as it was looked up.
    """

    annotation_id: uuid.UUID
    points: list[Any] | None
    sources: list[Any] | None
    revision: int
    updated_at: datetime
    author_id: uuid.UUID | None
    author: str | None = None


@dataclass(frozen=True)
class Found:
    """What there is at a place of a recording.

    Attributes:
        now: The annotation, a deleted one too; None when there never was one.
        done: What the operation made that was asked for.
        act: Of `done`.
    """

    recording: Extent
    now: Marked | None
    done: Marked | None
    act: str | None


class StaleAnnotationError(ConflictError):
    """Somebody changed the annotation meanwhile; `now` is how it is, None when there is none."""

    def __init__(self, place: Place, now: Marked | None) -> None:
        state = "there is none now" if now is None or now.points is None else f"it is at revision {now.revision}"
        super().__init__(f"The annotation of {place} was changed meanwhile; {state}. Yours was not stored.")
        self.now = now


_SEQUENCES, _ANNOTATIONS, _REVISIONS, _ACCOUNTS = (
    Base.metadata.tables[row.__tablename__] for row in (SequenceRow, AnnotationRow, AnnotationRevisionRow, Account)
)
_AUTHORS = _ACCOUNTS.alias()
_NOW, _DONE, _WHERE = _ANNOTATIONS.c, _REVISIONS.c, _SEQUENCES.c

_LOOK = (
    select(
        *(_NOW.id, _NOW.points, _NOW.sources, _NOW.revision, _NOW.updated_at, _NOW.author_id, _ACCOUNTS.c.name),
        *(_DONE.annotation_id, _DONE.points, _DONE.sources, _DONE.revision, _DONE.created_at, _DONE.author_id),
        *(_AUTHORS.c.name, _DONE.act),
        *(_WHERE.id, _WHERE.name, _WHERE.frame_count, _WHERE.cameras, _WHERE.deleted_at),
    )
    .select_from(_SEQUENCES)
    .outerjoin(
        _ANNOTATIONS,
        and_(
            _NOW.sequence_id == _WHERE.id,
            _NOW.replica == bindparam("replica"),
            _NOW.camera == bindparam("camera"),
            _NOW.frame == bindparam("frame"),
            _NOW.hand == bindparam("hand"),
        ),
    )
    .outerjoin(_ACCOUNTS, _ACCOUNTS.c.id == _NOW.author_id)
    .outerjoin(_REVISIONS, _DONE.operation_id == bindparam("operation_id"))
    .outerjoin(_AUTHORS, _AUTHORS.c.id == _DONE.author_id)
    .where(_WHERE.id == bindparam("sequence_id"))
)
_CHANGE = update(_ANNOTATIONS).where(_NOW.id == bindparam("changed"), _NOW.revision == bindparam("expected"))


def look_up(session: Session, place: Place, operation_id: uuid.UUID | None = None) -> Found:
    """What there is at a place, and what an operation made, wherever that was."""
    row = session.execute(_LOOK, vars(place) | {"operation_id": operation_id}).one_or_none()
    if row is None or row[-1] is not None:
        get_sequence(session, place.sequence_id)  # says what has become of it
    assert row is not None
    recording = Extent(*row[15:19])
    check_place(recording, place.camera, place.frame, place.hand)
    now, done = (None if part[0] is None else Marked(*part) for part in (row[:7], row[7:14]))
    return Found(recording, now, done, row[14])


def change_annotation(
    session: Session, place: Place, change: Change, check: Callable[[], None] | None = None
) -> Marked:
    """Do it, if the annotation is as expected. A repeated operation does nothing and gives what it made at first.

    Args:
        check: Raises when it must not be done (`policy.check_change`). A repeated operation is not asked again: its
            work may have been locked since.
    """
    found = look_up(session, place, change.operation_id)
    points = None if change.points is None else check_points(found.recording, place, change.points)
    now, done = found.now, found.done
    if done is not None:
        if now is None or (done.annotation_id, found.act, done.points) != (now.annotation_id, change.act, points):
            raise InvalidError(
                f"The operation_id {change.operation_id} belongs to another change; {place} was left as it is. "
                "Make a new operation_id for each change."
            )
        return done
    if check is not None:
        check()
    if change.act == "delete" and (now is None or now.points is None):
        raise NotFoundError(f"There is no annotation of {place}.")
    is_as_expected = now is None or now.points is None if change.expected is None else _is_at(now, change.expected)
    if not is_as_expected:
        raise StaleAnnotationError(place, now)
    made = _write(session, place, now, change, points)
    # None: on PostgreSQL another request was quicker, between our look and now.
    return change_annotation(session, place, change, check) if made is None else made


def _is_at(now: Marked | None, revision: int) -> bool:
    return now is not None and now.revision == revision


def _write(
    session: Session, place: Place, was: Marked | None, change: Change, points: list[Any] | None
) -> Marked | None:
    """What stands there then, with its line in the history; None when it is not any more as it was."""
    before = (None, None) if was is None else (was.sources, was.points)
    made = Marked(
        uuid.uuid4() if was is None else was.annotation_id,
        points,
        settle_sources(*before, points, change.sources),
        1 if was is None else was.revision + 1,
        utc_now(),
        change.account_id,
    )
    common = {"points": points, "sources": made.sources, "revision": made.revision, "author_id": made.author_id}
    values = common | {"decided": count_decided(points), "updated_at": made.updated_at}
    if was is None:
        try:
            with session.begin_nested():
                session.execute(insert(_ANNOTATIONS), vars(place) | values | {"id": made.annotation_id})
        except IntegrityError:
            return None
    else:
        stored = session.execute(_CHANGE, values | {"changed": was.annotation_id, "expected": was.revision})
        if not cast("CursorResult[Any]", stored).rowcount:
            return None
    line = {"annotation_id": made.annotation_id, "operation_id": change.operation_id, "act": change.act}
    session.execute(insert(_REVISIONS), common | line | {"created_at": made.updated_at})
    return made


def add_imported_annotations(
    session: Session, sequence: SequenceRow, annotations: Annotations, account_id: uuid.UUID
) -> int:
    """Take in the annotations that a recording brought along, each as its first revision; gives their number."""
    for item in annotations.items:
        place = check_place(sequence, item.camera, item.frame, item.hand)
        points = check_points(sequence, place, item.points.tolist())
        sources = write_sources(item.sources) or imported_sources(points, "the recording's own annotations")
        _write(session, place, None, Change("import", points, None, uuid.uuid4(), account_id, sources), points)
    return len(annotations.items)
