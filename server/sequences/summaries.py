"""What other packages know about recordings. They are above this one, so the app passes their answers in."""

from __future__ import annotations

import uuid
from collections.abc import Callable, Sequence
from typing import Annotated, Any

from fastapi import Depends
from sqlalchemy.orm import Session
from starlette.requests import HTTPConnection

from server.sequences.models import SequenceRow
from server.sequences.schemas import SequenceOut

SummaryFinder = Callable[[Session, Sequence[uuid.UUID]], dict[uuid.UUID, dict[str, Any]]]
"""For some recordings, fields of `SequenceOut` that a room knows."""


async def get_summary_finders(connection: HTTPConnection) -> tuple[SummaryFinder, ...]:
    """Those the app was put together with."""
    return connection.app.state.sequence_summaries


SummariesDep = Annotated[tuple[SummaryFinder, ...], Depends(get_summary_finders)]


def describe_sequences(
    session: Session, rows: Sequence[SequenceRow], finders: Sequence[SummaryFinder]
) -> list[SequenceOut]:
    """Recordings with all that is known of them: one query a finder, however many they are."""
    ids = [row.id for row in rows]
    found_of: dict[uuid.UUID, dict[str, Any]] = {id_: {} for id_ in ids}
    for find in finders if ids else ():
        for id_, found in find(session, ids).items():
            found_of[id_] |= found
    fields = SequenceOut.model_fields.keys() - {"annotated_frames", "done_frames", "best_track"}
    return [
        SequenceOut.model_validate({field: getattr(row, field) for field in fields} | found_of[row.id]) for row in rows
    ]
