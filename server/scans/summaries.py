"""What other packages know about scans. They are above this one, so the app passes their answers in."""

from __future__ import annotations

import uuid
from collections.abc import Callable, Sequence
from typing import Annotated, Any

from fastapi import Depends
from sqlalchemy.orm import Session
from starlette.requests import HTTPConnection

from server.access.service import find_names
from server.scans.models import ScanRow
from server.scans.schemas import ScanOut
from server.scans.service import write_geometry_key

SummaryFinder = Callable[[Session, Sequence[uuid.UUID]], dict[uuid.UUID, dict[str, Any]]]
"""For some scans, fields of `ScanOut` that a room knows."""


async def get_summary_finders(connection: HTTPConnection) -> tuple[SummaryFinder, ...]:
    """Those the app was put together with."""
    return connection.app.state.scan_summaries


Resized = Callable[[Session, ScanRow], None]
"""What a room does when a scan's size was corrected."""


async def get_resized(connection: HTTPConnection) -> tuple[Resized, ...]:
    """Those the app was put together with."""
    return connection.app.state.scan_resized


ResizedDep = Annotated[tuple[Resized, ...], Depends(get_resized)]
SummariesDep = Annotated[tuple[SummaryFinder, ...], Depends(get_summary_finders)]


def describe_scans(session: Session, rows: Sequence[ScanRow], finders: Sequence[SummaryFinder]) -> list[ScanOut]:
    """Scans with all that is known of them: one query a finder, however many they are."""
    ids = [row.id for row in rows]
    found_of: dict[uuid.UUID, dict[str, Any]] = {id_: {} for id_ in ids}
    for find in finders if ids else ():
        for id_, found in find(session, ids).items():
            found_of[id_] |= found
    people = find_names(session, (row.created_by for row in rows))
    own = ScanOut.model_fields.keys() - {"registration", "created_by_name", "geometry_key", "size_m"}
    return [
        ScanOut.model_validate(
            {field: getattr(row, field) for field in own}
            | {
                "size_m": row.size_m or sorted(row.extent_m, reverse=True),
                "created_by_name": people.get(row.created_by),
                "geometry_key": write_geometry_key(row.digest, row.revision),
            }
            | found_of[row.id]
        )
        for row in rows
    ]
