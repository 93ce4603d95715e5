"""What can be done with scans that are there."""

from __future__ import annotations

import re
import threading
import uuid
from collections import OrderedDict, defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from sqlalchemy import CursorResult, Select, func, select, update
from sqlalchemy.orm import Session

from server.database import utc_now
from server.database.paging import fetch_page
from server.database.texts import match_words
from server.errors import ConflictError, InvalidError, NotFoundError
from server.scans.cropping import LEAST_LEFT, check_crop, find_flags
from server.scans.geometry import pack_scan
from server.scans.models import ScanCropRow, ScanRow
from server.scans.schemas import CollectionOut, ScanCrop, ScanPatch
from server.scans.thumbnails import draw_thumbnail
from server.scans.units import check_size, find_old_unit, find_revision_unit, measure_kept, scale_strokes
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
        return query.where(*match_words(self.search, ScanRow.name))


def list_scans(
    session: Session, wanted: ScanFilter, cursor: str | None, limit: int
) -> tuple[Sequence[ScanRow], str | None]:
    """Newest first."""
    query = wanted.apply(select(ScanRow))
    return fetch_page(session, query, (ScanRow.created_at, ScanRow.id), cursor, limit)


def list_collections(session: Session) -> list[CollectionOut]:
    """Collections by name."""
    names: dict[str, list[str]] = defaultdict(list)
    pairs = select(ScanRow.collection, ScanRow.subject).where(ScanRow.deleted_at.is_(None), ScanRow.subject != "")
    for collection, subject in session.execute(pairs.distinct().order_by(ScanRow.subject)):
        names[collection].append(subject)
    query = (
        select(
            ScanRow.collection,
            func.count(),
            func.count().filter(ScanRow.state == "registered"),
            func.count().filter(ScanRow.state == "failed"),
        )
        .where(ScanRow.deleted_at.is_(None))
        .group_by(ScanRow.collection)
        .order_by(ScanRow.collection)
    )
    return [
        CollectionOut(
            name=name,
            scans=scans,
            subjects=len(names[name]),
            subject_names=names[name],
            registered=registered,
            failed=failed,
        )
        for name, scans, registered, failed in session.execute(query)
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
    """The whole scan, in the unit that it has now."""
    return _open_file(storage, row, row.metres_per_unit)


def _open_file(storage: Storage, row: ScanRow, metres_per_unit: float | None) -> Scan:
    from tracker import read_scan

    scan = read_scan(storage.folder(AREA, row.id) / row.file)
    return scan.scaled(find_old_unit(row, scan) if metres_per_unit is None else metres_per_unit)


@dataclass(frozen=True)
class Kept:
    """What a crop leaves of a scan: how many points go, and the sides (m) of a box around the others."""

    removed: int
    size_m: list[float]


def judge_crop(scan: Scan, crop: ScanCrop) -> Kept:
    """What a crop leaves; raises when that is too little."""
    check_crop(crop)
    flags = find_flags(scan, crop)
    removed = int(np.count_nonzero(flags))
    if len(scan.points) - removed < min(LEAST_LEFT, len(scan.points)):
        raise InvalidError(
            f"The crop leaves {len(scan.points) - removed} of {len(scan.points)} points; needed at least {LEAST_LEFT}. "
            "Remove less."
        )
    return Kept(removed, measure_kept(scan, flags))


def put_crop(
    session: Session, row: ScanRow, crop: ScanCrop, kept: Kept, revision: int, account_id: uuid.UUID
) -> ScanRow:
    """Replace what is left out of a scan, if that is still the revision given."""
    columns = {"removed_count": kept.removed, "size_m": kept.size_m}
    return _add_revision(session, row, crop, columns, revision, account_id)


def settle_old_unit(session: Session, storage: Storage, row: ScanRow) -> None:
    """Note the unit that an earlier version found for a scan without storing it; nothing changes by that."""
    from tracker import read_scan

    if row.metres_per_unit is None:
        unit = find_old_unit(row, read_scan(storage.folder(AREA, row.id) / row.file))
        row.metres_per_unit = row.first_metres_per_unit = unit
        session.flush()


@dataclass(frozen=True)
class Scaled:
    """A scan in another unit.

    Attributes:
        factor: How many times as large it is now.
        crop: What is left out, which is the same as before.
        size_m: Sides of what is kept, m, the longest first.
    """

    metres_per_unit: float
    factor: float
    crop: ScanCrop
    size_m: list[float]


def scale_scan(scan: Scan, row: ScanRow, crop_row: ScanCropRow | None, metres_per_unit: float) -> Scaled:
    """A whole scan, given in the unit that it has now, in another one; raises when its size is impossible then."""
    assert row.metres_per_unit is not None, "settle_old_unit has noted it"
    factor = metres_per_unit / row.metres_per_unit
    scaled, crop = scan.scaled(factor), read_crop(crop_row)
    crop = crop.model_copy(update={"strokes": scale_strokes(crop.strokes, factor)})
    size = measure_kept(scaled, find_flags(scaled, crop))
    check_size(size[0], metres_per_unit)
    return Scaled(metres_per_unit, factor, crop, size)


def put_unit(session: Session, row: ScanRow, scaled: Scaled, revision: int, account_id: uuid.UUID) -> ScanRow:
    """Correct the unit of a scan's file, if that is still the revision given. What is cropped stays cropped."""
    columns = {
        "metres_per_unit": scaled.metres_per_unit,
        "is_unit_guessed": False,
        "extent_m": [scaled.factor * side for side in row.extent_m],
        "size_m": scaled.size_m,
        "state": "new",
        "problem": None,
    }
    return _add_revision(session, row, scaled.crop, columns, revision, account_id)


def _add_revision(
    session: Session, row: ScanRow, crop: ScanCrop, columns: dict[str, Any], revision: int, account_id: uuid.UUID
) -> ScanRow:
    statement = (
        update(ScanRow)
        .where(ScanRow.id == row.id, ScanRow.revision == revision, ScanRow.deleted_at.is_(None))
        .values(revision=revision + 1, **columns)
        .execution_options(synchronize_session=False)
    )
    result = session.execute(statement)
    assert isinstance(result, CursorResult)
    now = session.get(ScanRow, row.id, populate_existing=True)
    assert now is not None
    if result.rowcount != 1:
        raise StaleScanError(f"The scan was changed meanwhile and is at revision {now.revision}. Load it again.")
    session.add(
        ScanCropRow(
            scan_id=row.id,
            revision=revision + 1,
            strokes=[stroke.model_dump(mode="json") for stroke in crop.strokes],
            drops_objects=crop.drops_objects,
            removed_count=now.removed_count,
            metres_per_unit=now.metres_per_unit,
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
    """Part of the address of a scan's geometry: another file, another crop or another unit has another."""
    return f"{digest[:24]}-{revision}"


def find_geometry_revision(row: ScanRow, key: str) -> int:
    """The revision of the crop that a key names."""
    match = _KEY.fullmatch(key)
    if match is None or match[1] != row.digest[:24] or int(match[2]) > row.revision:
        raise NotFoundError(f"The scan has no geometry {key!r}; its `geometry_key` says which it has.")
    return int(match[2])


class ScanCache:
    """Scans that were asked for lately, so that who moves on and back does not wait for the disk again."""

    def __init__(self, storage: Storage, most: int = 8) -> None:
        self.storage, self._most = storage, most
        self._scans: OrderedDict[tuple[uuid.UUID, float | None], Scan] = OrderedDict()
        self._lock = threading.Lock()

    def get(self, row: ScanRow) -> Scan:
        """The whole scan, in the unit that it has now."""
        return self._get(row, row.metres_per_unit)

    def _get(self, row: ScanRow, metres_per_unit: float | None) -> Scan:
        key = row.id, metres_per_unit
        with self._lock:
            if (scan := self._scans.get(key)) is not None:
                self._scans.move_to_end(key)
                return scan
        scan = _open_file(self.storage, row, metres_per_unit)
        with self._lock:
            self._scans[key] = scan
            while len(self._scans) > self._most:
                self._scans.popitem(last=False)
        return scan

    def pack(self, row: ScanRow, crop: ScanCropRow | None, size: int) -> bytes:
        """A scan for the browser, as of a revision."""
        scan = self._get(row, find_revision_unit(row, crop))
        flags = find_flags(scan, read_crop(crop))
        return pack_scan(scan.points, scan.normals, scan.colors, flags, size, row.digest)

    def draw(self, row: ScanRow, crop: ScanCropRow | None) -> bytes:
        """A small picture of what is left of a scan as of a revision."""
        scan = self._get(row, find_revision_unit(row, crop))
        return draw_thumbnail(scan, find_flags(scan, read_crop(crop)) == 0, row.digest)
