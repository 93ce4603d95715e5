"""What can be done with scans that are there."""

from __future__ import annotations

import re
import threading
import uuid
from collections import OrderedDict
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from sqlalchemy import CursorResult, Select, func, select, tuple_, update
from sqlalchemy.orm import Session

from server.database import utc_now
from server.database.paging import read_moment_cursor, write_cursor
from server.errors import ConflictError, InvalidError, NotFoundError
from server.scans.cropping import LEAST_LEFT, check_crop, find_flags
from server.scans.geometry import pack_scan
from server.scans.models import ScanCropRow, ScanRow
from server.scans.schemas import CollectionOut, ScanCrop, ScanPatch
from server.scans.thumbnails import draw_thumbnail
from server.storage import Storage

if TYPE_CHECKING:
    from tracker import Scan

AREA = "scans"
_KEY = re.compile(r"([0-9a-f]{24})-([1-9][0-9]{0,8})")


class StaleScanError(ConflictError):
    """Somebody cropped the scan meanwhile."""


@dataclass(frozen=True)
class ScanFilter:
    """Which scans are asked for; what is None or empty asks for nothing."""

    collection: str | None = None
    subject: str | None = None
    pose: str | None = None
    side: str | None = None
    state: str | None = None
    search: str | None = None

    def apply(self, query: Select[Any]) -> Select[Any]:
        query = query.where(ScanRow.deleted_at.is_(None))
        for name in ("collection", "subject", "pose", "side", "state"):
            if (wanted := getattr(self, name)) is not None:
                query = query.where(getattr(ScanRow, name) == wanted)
        for word in (self.search or "").split():
            query = query.where(ScanRow.name.icontains(word, autoescape=True))
        return query


def list_scans(
    session: Session, wanted: ScanFilter, cursor: str | None, limit: int
) -> tuple[Sequence[ScanRow], str | None]:
    """Newest first."""
    query = wanted.apply(select(ScanRow)).order_by(ScanRow.created_at.desc(), ScanRow.id.desc())
    if cursor is not None:
        query = query.where(tuple_(ScanRow.created_at, ScanRow.id) < read_moment_cursor(cursor))
    rows = session.scalars(query.limit(limit + 1)).all()
    if len(rows) <= limit:
        return rows, None
    return rows[:limit], write_cursor(rows[limit - 1].created_at.isoformat(), str(rows[limit - 1].id))


def list_collections(session: Session) -> list[CollectionOut]:
    """Collections by name."""
    query = (
        select(
            ScanRow.collection,
            func.count(),
            func.count(func.distinct(func.nullif(ScanRow.subject, ""))),
            func.count().filter(ScanRow.state == "registered"),
            func.count().filter(ScanRow.state == "failed"),
        )
        .where(ScanRow.deleted_at.is_(None))
        .group_by(ScanRow.collection)
        .order_by(ScanRow.collection)
    )
    return [
        CollectionOut(name=name, scans=scans, subjects=subjects, registered=registered, failed=failed)
        for name, scans, subjects, registered, failed in session.execute(query)
    ]


def get_scan(session: Session, scan_id: uuid.UUID, *, deleted_too: bool = False) -> ScanRow:
    """The scan of this id."""
    row = session.get(ScanRow, scan_id)
    if row is None or (row.deleted_at is not None and not deleted_too):
        gone = "was deleted; it can be restored" if row is not None else "does not exist"
        raise NotFoundError(f"The scan {scan_id} {gone}.")
    return row


def update_scan(session: Session, row: ScanRow, patch: ScanPatch) -> None:
    """Change how a scan is called."""
    for name, value in patch.model_dump(exclude_none=True).items():
        setattr(row, name, value)
    session.flush()


def get_crop(session: Session, scan_id: uuid.UUID, revision: int) -> ScanCropRow | None:
    """What is left out as of a revision; None for the whole scan."""
    query = select(ScanCropRow).where(ScanCropRow.scan_id == scan_id, ScanCropRow.revision == revision)
    return session.scalars(query).one_or_none()


def list_crops(session: Session, scan_id: uuid.UUID) -> Sequence[ScanCropRow]:
    """Every crop there was, the newest first."""
    query = select(ScanCropRow).where(ScanCropRow.scan_id == scan_id)
    return session.scalars(query.order_by(ScanCropRow.revision.desc())).all()


def read_crop(row: ScanCropRow | None) -> ScanCrop:
    """A row's crop; of the whole scan when there is none."""
    return ScanCrop(strokes=[]) if row is None else ScanCrop(strokes=row.strokes, drops_objects=row.drops_objects)


def open_scan(storage: Storage, row: ScanRow) -> Scan:
    """The whole scan, as it was uploaded."""
    from tracker import load_scan

    return load_scan(storage.folder(AREA, row.id) / row.file, row.metres_per_unit)


def count_removed(scan: Scan, crop: ScanCrop) -> int:
    """Points that a crop leaves out; raises when it leaves too few."""
    check_crop(crop)
    removed = int(np.count_nonzero(find_flags(scan, crop)))
    if len(scan.points) - removed < min(LEAST_LEFT, len(scan.points)):
        raise InvalidError(
            f"The crop leaves {len(scan.points) - removed} of {len(scan.points)} points; needed at least {LEAST_LEFT}. "
            "Remove less."
        )
    return removed


def put_crop(
    session: Session, row: ScanRow, crop: ScanCrop, removed: int, revision: int, account_id: uuid.UUID
) -> ScanRow:
    """Replace what is left out of a scan, if that is still the revision given."""
    statement = (
        update(ScanRow)
        .where(ScanRow.id == row.id, ScanRow.revision == revision, ScanRow.deleted_at.is_(None))
        .values(revision=revision + 1, removed_count=removed)
        .execution_options(synchronize_session=False)
    )
    result = session.execute(statement)
    assert isinstance(result, CursorResult)
    now = session.get(ScanRow, row.id, populate_existing=True)
    assert now is not None
    if result.rowcount != 1:
        raise StaleScanError(f"The scan was cropped meanwhile and is at revision {now.revision}. Load it again.")
    session.add(
        ScanCropRow(
            scan_id=row.id,
            revision=revision + 1,
            strokes=[stroke.model_dump(mode="json") for stroke in crop.strokes],
            drops_objects=crop.drops_objects,
            removed_count=removed,
            author_id=account_id,
        )
    )
    session.flush()
    return now


def delete_scan(session: Session, row: ScanRow) -> None:
    """Hide a scan; `restore_scan` undoes it. Its file stays, and what came of it."""
    row.deleted_at = utc_now()
    session.flush()


def restore_scan(session: Session, row: ScanRow) -> None:
    """Undo a deletion; nothing happens when there was none."""
    row.deleted_at = None
    session.flush()


def write_geometry_key(digest: str, revision: int) -> str:
    """Part of the address of a scan's geometry: another file or another crop has another."""
    return f"{digest[:24]}-{revision}"


def find_geometry_revision(row: ScanRow, key: str) -> int:
    """The revision of the crop that a key names."""
    match = _KEY.fullmatch(key)
    if match is None or match[1] != row.digest[:24] or int(match[2]) > row.revision:
        raise NotFoundError(f"The scan has no geometry {key!r}; its `geometry_key` says which it has.")
    return int(match[2])


class ScanShelf:
    """Scans that were asked for lately, so that who moves on and back does not wait for the disk again."""

    def __init__(self, storage: Storage, most: int = 8) -> None:
        self._storage, self._most = storage, most
        self._scans: OrderedDict[uuid.UUID, Scan] = OrderedDict()
        self._lock = threading.Lock()

    def get(self, row: ScanRow) -> Scan:
        """The whole scan."""
        with self._lock:
            if (scan := self._scans.get(row.id)) is not None:
                self._scans.move_to_end(row.id)
                return scan
        scan = open_scan(self._storage, row)
        with self._lock:
            self._scans[row.id] = scan
            while len(self._scans) > self._most:
                self._scans.popitem(last=False)
        return scan

    def pack(self, row: ScanRow, crop: ScanCrop, size: int) -> bytes:
        """A scan for the browser."""
        scan = self.get(row)
        flags = find_flags(scan, crop)
        return pack_scan(scan.points, scan.normals, scan.colors, flags, size, row.digest)

    def draw(self, row: ScanRow, crop: ScanCrop) -> bytes:
        """A small picture of what the crop leaves of a scan."""
        scan = self.get(row)
        return draw_thumbnail(scan, find_flags(scan, crop) == 0, row.digest)
