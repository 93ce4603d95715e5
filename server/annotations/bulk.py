"""Many annotations changed at once: all of them or none, each with its revision in the history."""

from __future__ import annotations

import uuid
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from sqlalchemy import select
from sqlalchemy.exc import IntegrityError
from sqlalchemy.orm import Session

from server.access.places import Place
from server.annotations.models import Act, AnnotationRevisionRow, AnnotationRow
from server.annotations.sources import count_decided, settle_sources
from server.database import utc_now
from server.errors import ConflictError

Key = tuple[int, str, str]
"""Frame, camera, hand."""


@dataclass(frozen=True)
class BulkChange:
    """One of them.

    Attributes:
        place: Where.
        act: For the history.
        points: 21 times [x, y, v], or None to delete.
        sources: As `Change.sources`.
    """

    place: Place
    act: Act
    points: list[Any] | None
    sources: list[Any] | None = None


def find_annotations(session: Session, sequence_id: uuid.UUID, *, hold: bool = False) -> dict[Key, AnnotationRow]:
    """Every annotation that everybody sees, deleted ones too; with `hold` nobody else changes one meanwhile."""
    query = select(AnnotationRow).where(AnnotationRow.sequence_id == sequence_id, AnnotationRow.replica == "")
    if hold:
        query = query.with_for_update().execution_options(populate_existing=True)
    return {(row.frame, row.camera, row.hand): row for row in session.scalars(query)}


def change_annotations(
    session: Session, held: dict[Key, AnnotationRow], changes: Sequence[BulkChange], account_id: uuid.UUID
) -> None:
    """Do all changes to annotations that `find_annotations` held."""
    now = utc_now()
    rows, revisions = [], []
    for change in changes:
        place = change.place
        row = held.get((place.frame, place.camera, place.hand))
        if row is None:
            row = AnnotationRow(id=uuid.uuid4(), **vars(place), revision=0)
            rows.append(row)
        row.sources = settle_sources(row.sources, row.points, change.points, change.sources)
        row.points, row.decided = change.points, count_decided(change.points)
        row.revision += 1
        row.updated_at, row.author_id = now, account_id
        revisions.append(
            AnnotationRevisionRow(
                annotation_id=row.id,
                revision=row.revision,
                operation_id=uuid.uuid4(),
                act=change.act,
                points=change.points,
                sources=row.sources,
                created_at=now,
                author_id=account_id,
            )
        )
    try:
        session.add_all(rows)
        session.flush()
        session.add_all(revisions)
        session.flush()
    except IntegrityError:  # somebody made an annotation where there was none when we looked
        raise ConflictError(
            "Somebody annotated one of these places meanwhile; nothing was stored. Try again."
        ) from None
