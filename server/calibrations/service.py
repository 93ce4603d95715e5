"""What can be done with camera calibrations. Films are read for seconds, so transactions are kept short."""

from __future__ import annotations

import uuid
from collections.abc import Sequence
from datetime import timedelta
from pathlib import Path

from sqlalchemy import select
from sqlalchemy.orm import Session

from server.access.audit import record_act
from server.calibrations import films, storing
from server.calibrations.checking import check_films
from server.calibrations.models import CalibrationRow
from server.calibrations.schemas import CalibrationCheck, CalibrationOptions, FilmReport
from server.database import Database, utc_now
from server.database.paging import fetch_page
from server.errors import ConflictError, NotFoundError
from server.storage import Storage
from server.storage.upload import Upload

GONE = "Its films were removed because nobody had used them for long. Upload them again."


def list_calibrations(session: Session, cursor: str | None, limit: int) -> tuple[Sequence[CalibrationRow], str | None]:
    """Those that are not deleted, the newest first."""
    query = select(CalibrationRow).where(CalibrationRow.deleted_at.is_(None))
    return fetch_page(session, query, (CalibrationRow.created_at, CalibrationRow.id), cursor, limit)


def get_calibration(session: Session, calibration_id: uuid.UUID) -> CalibrationRow:
    """The calibration of this id."""
    row = session.get(CalibrationRow, calibration_id)
    if row is None or row.deleted_at is not None:
        gone = "This camera calibration was deleted."
        raise NotFoundError(f"There is no camera calibration {calibration_id}." if row is None else gone)
    return row


def add_calibration(
    database: Database,
    storage: Storage,
    films_id: uuid.UUID,
    name: str,
    options: CalibrationOptions,
    upload: Upload,
    account_id: uuid.UUID,
) -> CalibrationRow:
    """Look at films that have arrived whole, and note what was found."""
    try:
        report = check_films(storage.folder(films.AREA, films_id), options)
        row = _make_row(films_id, name, options, report, account_id)
        row.file_count, row.byte_count = len(upload.names), upload.byte_count
        with database.writing() as session:
            session.add(row)
            session.flush()
            record_act(session, account_id, "calibration.upload", "calibration", row.id)
        return row
    except BaseException:
        storage.remove(films.AREA, films_id)
        raise


def check_again(
    database: Database, storage: Storage, calibration_id: uuid.UUID, asked: CalibrationCheck, account_id: uuid.UUID
) -> CalibrationRow:
    """Look at the films with other options. What has a result stays as it is, and a new calibration is made."""
    with database.reading() as session:
        before = get_calibration(session, calibration_id)
    folder = films.find_films(storage, before.films_id)
    if folder is None:
        raise ConflictError(GONE)
    report = check_films(folder, asked.options)
    name = asked.name or before.name
    with database.writing() as session:
        row = get_calibration(session, calibration_id)
        if row.result is None:
            row.name, row.options = name, asked.options.model_dump()
            row.report, row.state = report.model_dump(), _judge(report)
            row.updated_at = utc_now()
        else:
            row = _make_row(row.films_id, name, asked.options, report, account_id)
            row.file_count, row.byte_count = before.file_count, before.byte_count
            session.add(row)
            session.flush()
            record_act(session, account_id, "calibration.again", "calibration", row.id)
    return row


def delete_calibration(session: Session, row: CalibrationRow, account_id: uuid.UUID) -> None:
    """Put a calibration into the bin. Recordings that took its cameras keep them."""
    row.deleted_at = utc_now()
    session.flush()
    record_act(session, account_id, "calibration.delete", "calibration", row.id)


def find_file(storage: Storage, row: CalibrationRow, name: str) -> Path:
    """A file of the result; `name` is one of the studio's own."""
    path = storage.folder(storing.AREA, row.id) / name
    if row.result is None or not path.is_file():
        raise NotFoundError(
            f"The cameras of “{row.name}” are not calibrated yet."
            if row.result is None
            else f"“{row.name}” has no file {name}."
        )
    return path


def remove_abandoned(database: Database, storage: Storage, hours: float) -> int:
    """Remove films that nobody has touched for long, and calibrations without a result that had them; their number."""
    oldest = utc_now() - timedelta(hours=hours)
    with database.writing() as session:
        used = set(session.scalars(select(CalibrationRow.films_id).where(CalibrationRow.updated_at >= oldest)))
        stale = select(CalibrationRow).where(CalibrationRow.updated_at < oldest, CalibrationRow.result.is_(None))
        for row in session.scalars(stale):
            session.delete(row)
    removed = 0
    for area in (films.AREA, films.UPLOADS):
        for id_ in storage.list_ids(area):
            if id_ not in used and _is_older(storage.folder(area, id_), oldest.timestamp()):
                storage.remove(area, id_)
                removed += 1
        storage.sweep(area)
    return removed


def _is_older(folder: Path, moment: float) -> bool:
    try:
        return folder.stat().st_mtime < moment
    except FileNotFoundError:
        return False


def _make_row(
    films_id: uuid.UUID, name: str, options: CalibrationOptions, report: FilmReport, account_id: uuid.UUID
) -> CalibrationRow:
    return CalibrationRow(
        id=uuid.uuid4(),
        name=name,
        state=_judge(report),
        options=options.model_dump(),
        report=report.model_dump(),
        films_id=films_id,
        created_by=account_id,
    )


def _judge(report: FilmReport) -> str:
    return "refused" if report.problems else "checked"
