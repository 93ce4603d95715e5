"""What can be done with fingertip detectors."""

from __future__ import annotations

import shutil
import uuid
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from sqlalchemy import select
from sqlalchemy.orm import Session

from server.access.audit import record_act
from server.database import utc_now
from server.database.paging import fetch_page
from server.detectors.models import DetectorRow
from server.errors import ConflictError, InvalidError, NotFoundError
from server.storage import Storage
from server.storage.digest import compute_digest

if TYPE_CHECKING:
    from tracker.detection import OwnDetector

AREA = "detectors"
FILE = "detector.npz"


class DamagedDetectorError(ConflictError):
    """The file is not what it was when the detector was stored."""


def list_detectors(session: Session, cursor: str | None, limit: int) -> tuple[Sequence[DetectorRow], str | None]:
    """Those that are not deleted, the newest first."""
    query = select(DetectorRow).where(DetectorRow.deleted_at.is_(None))
    return fetch_page(session, query, (DetectorRow.created_at, DetectorRow.id), cursor, limit)


def get_detector(session: Session, detector_id: uuid.UUID, *, deleted_too: bool = False) -> DetectorRow:
    """The stored detector of this id."""
    row = session.get(DetectorRow, detector_id)
    if row is None or (row.deleted_at is not None and not deleted_too):
        gone = "This fingertip detector was deleted."
        raise NotFoundError(f"There is no fingertip detector {detector_id}." if row is None else gone)
    return row


def read_upload(path: Path) -> OwnDetector:
    """The detector in a file that somebody sent; a file that is none is refused with the reason."""
    from tracker import TrackerError
    from tracker.detection import load_detector

    try:
        detector = load_detector(path)
    except TrackerError as error:
        raise InvalidError(str(error).replace(f"{path.parent}/", "")) from None
    if detector.forest.what != "fingertips":
        raise InvalidError(
            f"{path.name}: found a detector of {detector.forest.what}; needed one of fingertips. Nails are looked for "
            "by `handloom track --cameras A,B --detector FILE` alone."
        )
    return detector


def add_detector(
    session: Session, storage: Storage, path: Path, detector: OwnDetector, name: str, account_id: uuid.UUID
) -> DetectorRow:
    """Store the file of a detector, to the byte."""
    detector_id = uuid.uuid4()
    folder = storage.folder(AREA, detector_id)
    folder.mkdir()
    shutil.copyfile(path, folder / FILE)
    storage.publish(AREA, detector_id)
    row = DetectorRow(
        id=detector_id,
        name=name,
        looks_at=detector.forest.kind,
        trees=detector.forest.num_trees,
        byte_count=path.stat().st_size,
        digest=detector.sha256,
        created_by=account_id,
    )
    session.add(row)
    session.flush()
    record_act(session, account_id, "detector.upload", "detector", detector_id, sha256=row.digest)
    return row


def delete_detector(session: Session, row: DetectorRow, account_id: uuid.UUID) -> None:
    """Put a detector into the bin. Tracks made with it keep their own copy."""
    row.deleted_at = utc_now()
    session.flush()
    record_act(session, account_id, "detector.delete", "detector", row.id)


def find_file(storage: Storage, row: DetectorRow) -> Path:
    """The file of a stored detector; raises when it is not what it was."""
    path = storage.folder(AREA, row.id) / FILE
    if not path.is_file() or compute_digest(path) != row.digest:
        raise DamagedDetectorError(
            f"The file of the fingertip detector {row.name!r} is missing or was changed. Restore "
            f"{AREA}/{row.id}/{FILE} from a backup."
        )
    return path
