"""Annotations: read, written, taken back. Every change adds a row to the history and none is ever overwritten there."""

from __future__ import annotations

import uuid
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from sqlalchemy import Label, and_, case, distinct, func, not_, null, select, tuple_
from sqlalchemy.exc import IntegrityError
from sqlalchemy.orm import Session

from server.annotations.models import Act, AnnotationRevisionRow, AnnotationRow
from server.annotations.sources import (
    JOINT_COUNT,
    carry_sources,
    count_decided,
    imported_sources,
    read_sources,
    write_sources,
)
from server.database import utc_now
from server.database.paging import read_cursor, write_cursor
from server.errors import ConflictError, InvalidError, NotFoundError
from server.sequences.models import SequenceRow
from tracker import Annotation, Annotations


@dataclass(frozen=True)
class Place:
    """Where an annotation belongs: one hand in one image, in a blind replica or (empty) for everybody."""

    sequence_id: uuid.UUID
    camera: str
    frame: int
    hand: str
    replica: str = ""

    def __str__(self) -> str:
        return f"the {self.hand} hand in frame {self.frame} of {self.camera}"


@dataclass(frozen=True)
class HiddenPlaces:
    """Places that somebody must not read: every one of these hands in every one of these cameras and frames."""

    frames: frozenset[int]
    cameras: frozenset[str]
    hands: frozenset[str]

    def __contains__(self, place: Place) -> bool:
        return place.frame in self.frames and place.camera in self.cameras and place.hand in self.hands


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
    points: list[Any] | None
    expected: int | None
    operation_id: uuid.UUID
    account_id: uuid.UUID
    sources: list[Any] | None = None


class StaleAnnotationError(ConflictError):
    """Somebody changed the annotation meanwhile; `row` is how it is now, None when there is none."""

    def __init__(self, place: Place, row: AnnotationRow | None) -> None:
        now = "there is none now" if row is None or row.points is None else f"it is at revision {row.revision}"
        super().__init__(f"The annotation of {place} was changed meanwhile; {now}. Yours was not stored.")
        self.row = row


def check_place(sequence: SequenceRow, camera: str, frame: int, hand: str, replica: str = "") -> Place:
    """The place, if the recording has it."""
    if camera not in (known := [item["id"] for item in sequence.cameras]):
        raise NotFoundError(f"{sequence.name} has no camera {camera!r}; it has {known}.")
    if not 0 <= frame < sequence.frame_count:
        raise NotFoundError(f"{sequence.name} has no frame {frame}; they go from 0 to {sequence.frame_count - 1}.")
    return Place(sequence.id, camera, frame, hand, replica)


def check_points(sequence: SequenceRow, place: Place, points: Sequence[Sequence[float]]) -> list[Any]:
    """The points ready to be stored. Joints that are there may lie outside the image by its size at most."""
    camera = next(item for item in sequence.cameras if item["id"] == place.camera)
    width, height = camera["width"], camera["height"]
    for number, (x, y, v) in enumerate(points):
        if v and not (-width <= x <= 2 * width and -height <= y <= 2 * height):
            raise InvalidError(
                f"points.{number} is at ({x:g}, {y:g}), far outside the image of {width}x{height} px. "
                "Mark a joint that is not in the image as absent (v = 0)."
            )
    return [[float(x), float(y), int(v)] for x, y, v in points]


def find_annotation(session: Session, place: Place, *, for_update: bool = False) -> AnnotationRow | None:
    """The annotation at a place, a deleted one too."""
    query = select(AnnotationRow).where(
        AnnotationRow.sequence_id == place.sequence_id,
        AnnotationRow.replica == place.replica,
        AnnotationRow.camera == place.camera,
        AnnotationRow.frame == place.frame,
        AnnotationRow.hand == place.hand,
    )
    if for_update:
        query = query.with_for_update().execution_options(populate_existing=True)
    return session.scalars(query).one_or_none()


def get_annotation(session: Session, place: Place, *, deleted_too: bool = False) -> AnnotationRow:
    """The annotation at a place."""
    row = find_annotation(session, place)
    if row is None or (row.points is None and not deleted_too):
        raise NotFoundError(f"There is no annotation of {place}.")
    return row


def change_annotation(
    session: Session, place: Place, change: Change, check: Callable[[], None] | None = None
) -> AnnotationRevisionRow:
    """Do it, if the annotation is as expected. A repeated operation does nothing and gives what it made at first.

    Args:
        check: Raises when it must not be done (`guards.check_change`). A repeated operation is not asked again: its
            work may have been locked since.
    """
    row = find_annotation(session, place, for_update=True)
    if (done := _find_operation(session, row, place, change)) is not None:
        return done
    if check is not None:
        check()
    if change.act == "delete" and (row is None or row.points is None):
        raise NotFoundError(f"There is no annotation of {place}.")
    if row is None:
        if change.expected is not None:
            raise StaleAnnotationError(place, None)
        try:
            with session.begin_nested():
                row = AnnotationRow(**vars(place), points=None, revision=0)
                session.add(row)
                session.flush()
        except IntegrityError:  # another request made it between our look and now
            return change_annotation(session, place, change, check)
    elif not (row.points is None if change.expected is None else row.revision == change.expected):
        raise StaleAnnotationError(place, row)
    return _write(session, row, change)


def _find_operation(
    session: Session, row: AnnotationRow | None, place: Place, change: Change
) -> AnnotationRevisionRow | None:
    query = select(AnnotationRevisionRow).where(AnnotationRevisionRow.operation_id == change.operation_id)
    done = session.scalars(query).one_or_none()
    if done is None:
        return None
    row = row or find_annotation(session, place)  # the same operation may have made it since we looked
    if row is None or done.annotation_id != row.id or done.act != change.act or done.points != change.points:
        raise InvalidError(
            f"The operation {change.operation_id} was another change before; {place} was left as it is. "
            "Make a new operation_id for each change."
        )
    return done


def _write(session: Session, row: AnnotationRow, change: Change) -> AnnotationRevisionRow:
    set_points(row, change.points, change.sources)
    row.revision += 1
    row.updated_at = utc_now()
    row.author_id = change.account_id
    made = AnnotationRevisionRow(
        annotation_id=row.id,
        revision=row.revision,
        operation_id=change.operation_id,
        act=change.act,
        points=change.points,
        sources=row.sources,
        created_at=row.updated_at,
        author_id=change.account_id,
    )
    session.add(made)
    session.flush()
    return made


def set_points(row: AnnotationRow, points: list[Any] | None, sources: list[Any] | None) -> None:
    """New joints, with where they came from and how many are decided."""
    if points is None:
        row.sources = None
    else:
        row.sources = carry_sources(row.sources, row.points, points) if sources is None else sources
    row.points = points
    row.decided = count_decided(points)


def list_history(session: Session, row: AnnotationRow) -> Sequence[AnnotationRevisionRow]:
    """Every revision of an annotation, newest first."""
    query = select(AnnotationRevisionRow).where(AnnotationRevisionRow.annotation_id == row.id)
    return session.scalars(query.order_by(AnnotationRevisionRow.revision.desc())).all()


def get_past(session: Session, row: AnnotationRow, revision: int) -> AnnotationRevisionRow:
    """An earlier revision that has points."""
    query = select(AnnotationRevisionRow).where(
        AnnotationRevisionRow.annotation_id == row.id, AnnotationRevisionRow.revision == revision
    )
    past = session.scalars(query).one_or_none()
    if past is None:
        raise NotFoundError(f"There is no revision {revision}; they go from 1 to {row.revision}.")
    if past.points is None:
        raise InvalidError(f"Revision {revision} is a deletion. Delete the annotation instead of restoring it.")
    return past


def find_revisions(session: Session, sequence_id: uuid.UUID) -> dict[uuid.UUID, int]:
    """The revision of every annotation of a recording, by its id."""
    query = select(AnnotationRow.id, AnnotationRow.revision).where(
        AnnotationRow.sequence_id == sequence_id, AnnotationRow.replica == "", AnnotationRow.points.is_not(null())
    )
    return {id_: revision for id_, revision in session.execute(query)}  # noqa: C416


def list_annotations(
    session: Session,
    sequence_id: uuid.UUID,
    *,
    camera: str | None = None,
    frames: tuple[int | None, int | None] = (None, None),
    cursor: str | None = None,
    limit: int | None = None,
    replica: str = "",
    hidden: Sequence[HiddenPlaces] = (),
) -> tuple[Sequence[AnnotationRow], str | None]:
    """Annotations of a recording by frame, camera, hand; `frames` are the first and the last, both taken in."""
    order = (AnnotationRow.frame, AnnotationRow.camera, AnnotationRow.hand)
    query = select(AnnotationRow).where(
        AnnotationRow.sequence_id == sequence_id,
        AnnotationRow.replica == replica,
        AnnotationRow.points.is_not(null()),
    )
    if camera is not None:
        query = query.where(AnnotationRow.camera == camera)
    if frames[0] is not None:
        query = query.where(AnnotationRow.frame >= frames[0])
    if frames[1] is not None:
        query = query.where(AnnotationRow.frame <= frames[1])
    for places in hidden:
        query = query.where(
            not_(
                and_(
                    AnnotationRow.frame.in_(places.frames),
                    AnnotationRow.camera.in_(places.cameras),
                    AnnotationRow.hand.in_(places.hands),
                )
            )
        )
    if cursor is not None:
        query = query.where(tuple_(*order) > tuple(read_cursor(cursor, int, str, str)))
    query = query.order_by(*order)
    rows = session.scalars(query if limit is None else query.limit(limit + 1)).all()
    if limit is None or len(rows) <= limit:
        return rows, None
    last = rows[limit - 1]
    return rows[:limit], write_cursor(last.frame, last.camera, last.hand)


def load_annotations(
    session: Session, sequence_id: uuid.UUID, replica: str = "", hidden: Sequence[HiddenPlaces] = ()
) -> Annotations:
    """All annotations of a recording, or of a blind replica, as they are now."""
    rows, _ = list_annotations(session, sequence_id, replica=replica, hidden=hidden)
    return Annotations(
        tuple(
            Annotation(
                row.frame, row.camera, row.hand, np.array(row.points, dtype=np.float64), read_sources(row.sources)
            )
            for row in rows
        )
    )


def export_annotations(
    session: Session, sequence_id: uuid.UUID, replica: str = "", hidden: Sequence[HiddenPlaces] = ()
) -> dict[str, Any]:
    """The content of `annotations.json`."""
    return load_annotations(session, sequence_id, replica, hidden).to_json()


def add_imported_annotations(
    session: Session, sequence: SequenceRow, annotations: Annotations, account_id: uuid.UUID
) -> int:
    """Take in the annotations that a recording brought along, each as its first revision; gives their number."""
    for item in annotations.items:
        place = check_place(sequence, item.camera, item.frame, item.hand)
        points = check_points(sequence, place, item.points.tolist())
        row = AnnotationRow(id=uuid.uuid4(), **vars(place), points=None, revision=0)
        session.add(row)
        session.flush()
        sources = write_sources(item.sources) or imported_sources(points, "the recording's own annotations")
        _write(session, row, Change("import", points, None, uuid.uuid4(), account_id, sources))
    return len(annotations.items)


def find_annotated_frames(session: Session, ids: Sequence[uuid.UUID]) -> dict[uuid.UUID, dict[str, Any]]:
    """How many frames of some recordings are annotated, and how many of those to the end (`done_frames`)."""
    marked = (
        select(AnnotationRow.sequence_id, AnnotationRow.frame, *measure_frame())
        .where(AnnotationRow.sequence_id.in_(ids), AnnotationRow.replica == "", AnnotationRow.decided > 0)
        .group_by(AnnotationRow.sequence_id, AnnotationRow.frame)
        .subquery()
    )
    query = select(marked.c.sequence_id, marked.c.hands, marked.c.least, func.count()).group_by(
        marked.c.sequence_id, marked.c.hands, marked.c.least
    )
    recorded = session.execute(select(SequenceRow.id, SequenceRow.hands).where(SequenceRow.id.in_(ids)))
    asked = {id_: len(hands) or 1 for id_, hands in recorded}
    facts: dict[uuid.UUID, dict[str, Any]] = {}
    for id_, hands, least, count in session.execute(query):
        found = facts.setdefault(id_, {"annotated_frames": 0, "done_frames": 0})
        found["annotated_frames"] += count
        if is_frame_done(hands, least, asked[id_]):
            found["done_frames"] += count
    return facts


def measure_frame() -> tuple[Label[int], Label[int]]:
    """Of the annotations of one frame: hands decided whole in some camera, joints decided of the least done."""
    whole = case((AnnotationRow.decided == JOINT_COUNT, AnnotationRow.hand))
    return func.count(distinct(whole)).label("hands"), func.min(AnnotationRow.decided).label("least")


def is_frame_done(hands: int, least: int, asked: int) -> bool:
    """Every hand asked for is decided whole in some camera, and nothing that was begun is left half done."""
    return hands >= asked and least == JOINT_COUNT
