"""Annotations: read, written, taken back. Every change adds a row to the history and none is ever overwritten there."""

from __future__ import annotations

import uuid
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from sqlalchemy import Label, and_, case, distinct, func, not_, null, select
from sqlalchemy.orm import Session

from server.access.places import HiddenPlaces, Place
from server.annotations.models import AnnotationRevisionRow, AnnotationRow
from server.annotations.sources import JOINT_COUNT, read_sources
from server.database.paging import fetch_page
from server.errors import InvalidError, NotFoundError
from server.sequences.models import SequenceRow
from tracker import Annotation, Annotations


@dataclass(frozen=True)
class Extent:
    """Of a recording, as much as says where hands can be: what a save reads of it."""

    id: uuid.UUID
    name: str
    frame_count: int
    cameras: list[Any]


def check_place(sequence: SequenceRow | Extent, camera: str, frame: int, hand: str, replica: str = "") -> Place:
    """The place, if the recording has it."""
    if camera not in (known := [item["id"] for item in sequence.cameras]):
        raise NotFoundError(f"{sequence.name} has no camera {camera!r}; it has {known}.")
    if not 0 <= frame < sequence.frame_count:
        raise NotFoundError(f"{sequence.name} has no frame {frame}; they go from 0 to {sequence.frame_count - 1}.")
    return Place(sequence.id, camera, frame, hand, replica)


def check_points(sequence: SequenceRow | Extent, place: Place, points: Sequence[Sequence[float]]) -> list[Any]:
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


def find_annotation(session: Session, place: Place) -> AnnotationRow | None:
    """The annotation at a place, a deleted one too."""
    query = select(AnnotationRow).where(
        AnnotationRow.sequence_id == place.sequence_id,
        AnnotationRow.replica == place.replica,
        AnnotationRow.camera == place.camera,
        AnnotationRow.frame == place.frame,
        AnnotationRow.hand == place.hand,
    )
    return session.scalars(query).one_or_none()


def get_annotation(session: Session, place: Place, *, deleted_too: bool = False) -> AnnotationRow:
    """The annotation at a place."""
    row = find_annotation(session, place)
    if row is None or (row.points is None and not deleted_too):
        raise NotFoundError(f"There is no annotation of {place}.")
    return row


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
    if limit is None:
        return session.scalars(query.order_by(*order)).all(), None
    return fetch_page(session, query, order, cursor, limit, is_falling=False)


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
