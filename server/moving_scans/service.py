"""What can be done with moving scans that are there."""

from __future__ import annotations

import uuid
from collections.abc import Sequence
from pathlib import Path

from sqlalchemy import select
from sqlalchemy.orm import Session

from server.database import utc_now
from server.database.paging import fetch_page
from server.database.texts import match_words
from server.errors import NotFoundError
from server.moving_scans.adding import AREA
from server.moving_scans.frame_files import find_view
from server.moving_scans.models import MovingScanRow
from server.moving_scans.schemas import MovingScanPatch
from server.storage import Storage


def list_moving_scans(
    session: Session, search: str | None, cursor: str | None, limit: int
) -> tuple[Sequence[MovingScanRow], str | None]:
    """Newest first."""
    query = select(MovingScanRow).where(MovingScanRow.deleted_at.is_(None))
    query = query.where(*match_words(search, MovingScanRow.name, MovingScanRow.subject))
    return fetch_page(session, query, (MovingScanRow.created_at, MovingScanRow.id), cursor, limit)


def get_moving_scan(session: Session, id_: uuid.UUID, *, deleted_too: bool = False) -> MovingScanRow:
    """The moving scan of this id."""
    row = session.get(MovingScanRow, id_)
    if row is None or (row.deleted_at is not None and not deleted_too):
        gone = "was deleted; it can be restored from the bin" if row is not None else "does not exist"
        raise NotFoundError(f"The moving scan {id_} {gone}.")
    return row


def update_moving_scan(session: Session, row: MovingScanRow, patch: MovingScanPatch) -> None:
    """Change how it is called, who is scanned, or how fast it is played."""
    for name, value in patch.model_dump(exclude_none=True).items():
        setattr(row, name, value)
    session.flush()


def delete_moving_scan(session: Session, row: MovingScanRow) -> None:
    """Put it into the bin; its files stay, and what came of it."""
    row.deleted_at = utc_now()
    session.flush()


def find_scan_file(storage: Storage, row: MovingScanRow, frame: int) -> Path:
    """The file of a frame as it was uploaded."""
    return storage.folder(AREA, row.id) / _get_frame(row, frame)["file"]


def find_frame_view(storage: Storage, row: MovingScanRow, frame: int) -> Path:
    """The file with a frame's points for the browser."""
    problem = _get_frame(row, frame)["problem"]
    if problem is not None:
        raise NotFoundError(f"Frame {frame} of “{row.name}” cannot be shown: {problem}")
    return find_view(storage.folder(AREA, row.id), frame)


def list_usable(row: MovingScanRow, first: int, last: int) -> list[int]:
    """Frames from `first` to `last` whose files can be used."""
    return [frame for frame in range(first, last + 1) if row.frames[frame]["problem"] is None]


def _get_frame(row: MovingScanRow, frame: int) -> dict:
    if not 0 <= frame < row.frame_count:
        raise NotFoundError(f"“{row.name}” has no frame {frame}; it has 0 to {row.frame_count - 1}.")
    return row.frames[frame]
