"""A page of a recording's annotations, made in the process for long computations."""

from __future__ import annotations

import json
import uuid
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from sqlalchemy.orm import Session

from server.access.places import HiddenPlaces
from server.access.service import find_names
from server.annotations import service
from server.annotations.models import AnnotationRow
from server.annotations.schemas import SOURCE_DEFAULTS
from server.compute import ComputeContext


@dataclass(frozen=True)
class AnnotationQuestion:
    """Which annotations of which recording.

    Attributes:
        hidden: Places that whoever asks must not read.
        camera: Only of this one.
        frames: The first and the last, both taken in.
    """

    sequence_id: uuid.UUID
    hidden: Sequence[HiddenPlaces]
    replica: str
    camera: str | None
    frames: tuple[int | None, int | None]
    cursor: str | None
    limit: int


def make_annotation_page(context: ComputeContext, asked: AnnotationQuestion) -> bytes:
    """A `Page[AnnotationOut]` as JSON. All pages that come back after an outage ask for thousands of hands at once."""
    with context.database.reading() as session:
        rows, next_cursor = service.list_annotations(
            session,
            asked.sequence_id,
            camera=asked.camera,
            frames=asked.frames,
            cursor=asked.cursor,
            limit=asked.limit,
            replica=asked.replica,
            hidden=asked.hidden,
        )
        items = write_out(session, rows)
    return json.dumps({"items": items, "next_cursor": next_cursor}, separators=(",", ":")).encode()


def write_out(session: Session, rows: Sequence[AnnotationRow]) -> list[dict[str, Any]]:
    """Each as an AnnotationOut in JSON, without checking again the joints that were checked when they were stored."""
    names = find_names(session, [row.author_id for row in rows])
    return [
        {
            "frame": row.frame,
            "camera": row.camera,
            "hand": row.hand,
            "points": row.points,
            "sources": row.sources and [source and SOURCE_DEFAULTS | source for source in row.sources],
            "revision": row.revision,
            "updated_at": row.updated_at.isoformat().replace("+00:00", "Z"),
            "author": names.get(row.author_id),
        }
        for row in rows
    ]
