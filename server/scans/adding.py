"""Files become scans: each by itself, so that one that is damaged keeps no other out.

Files are read for milliseconds to seconds each, so the functions take the database and keep transactions short.
"""

from __future__ import annotations

import os
import shutil
import uuid
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import BaseModel, ConfigDict, Field
from sqlalchemy import select
from sqlalchemy.orm import Session

from server.access.audit import record_act
from server.database import Database
from server.database.texts import Label, Name
from server.errors import StudioError
from server.scans.cropping import find_flags
from server.scans.folder import ListedScan, find_scans
from server.scans.models import ScanRow
from server.scans.schemas import ScanCrop, ScanRefusal, Side, UnitScale
from server.scans.service import AREA
from server.scans.units import measure_kept
from server.storage import Storage
from server.storage.digest import compute_digest
from server.storage.sent_json import read_options, reading_json


class ScanOptions(BaseModel):
    """What files do not tell; `scans.json` wins over it."""

    model_config = ConfigDict(extra="forbid")

    collection: Name = "scans"
    subject: Label = ""
    pose: Label = ""
    side: Side | None = None
    metres_per_unit: UnitScale | None = None
    units: dict[str, UnitScale] = Field(default={}, max_length=2000)
    """By the path of a file in the upload, of those that have another unit."""


@dataclass
class Added:
    """What became of some files."""

    added: list[ScanRow] = field(default_factory=list)
    known: list[ScanRow] = field(default_factory=list)
    refused: list[ScanRefusal] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)


def parse_options(text: str) -> ScanOptions:
    """Options from a form's field: a JSON object, or nothing."""
    return make_options(read_options(text))


def make_options(options: dict[str, Any]) -> ScanOptions:
    """Options that somebody gave; raises for what they cannot be."""
    with reading_json("What was given for the scans", "options that fit them"):
        return ScanOptions.model_validate(options)


def add_scans(
    database: Database, storage: Storage, folder: Path, options: ScanOptions, account_id: uuid.UUID, *, moves: bool
) -> Added:
    """Make scans of all that a folder holds.

    Args:
        database: Where their rows go.
        storage: Where their files go.
        folder: With files in it, at any depth; or one file.
        options: What nobody else tells.
        account_id: Who.
        moves: Whether the files may be moved away, such as those of an upload.
    """
    found = find_scans(folder)
    done = Added()
    for name, path in found.scans.items():
        columns = _describe(name, found.listed.get(name), options)
        try:
            row, is_new = _add_one(database, storage, path, columns, account_id, moves)
        except StudioError as fault:
            done.refused.append(ScanRefusal(file=name, detail=fault.detail))
        except Exception as fault:
            from tracker import TrackerError

            if not isinstance(fault, TrackerError):
                raise
            done.refused.append(ScanRefusal(file=name, detail=found.hide_root(str(fault))))
        else:
            (done.added if is_new else done.known).append(row)
            if not is_new and (note := _compare_unit(name, row, columns["metres_per_unit"])):
                done.notes.append(note)
    done.notes += found.write_notes()
    return done


def _compare_unit(name: str, row: ScanRow, wanted: float | None) -> str | None:
    """That a scan which is there already has another unit than was said this time, if so."""
    if wanted is None or row.metres_per_unit in (None, wanted):
        return None
    assert row.metres_per_unit is not None
    return (
        f"{name} is there already as {row.name}, with 1 unit = {1e3 * row.metres_per_unit:.6g} mm. It keeps "
        "that unit, which can be changed on its page."
    )


def _describe(name: str, line: ListedScan | None, options: ScanOptions) -> dict[str, Any]:
    line = line or ListedScan(file=name)
    stem = "".join(c for c in Path(name).with_suffix("").as_posix() if c.isprintable()).strip()[-200:]
    return {
        "name": line.name or stem or "scan",
        "collection": options.collection,
        "subject": line.subject or options.subject,
        "pose": line.pose or options.pose,
        "side": line.side or options.side,
        "metres_per_unit": line.metres_per_unit or options.units.get(name) or options.metres_per_unit,
    }


def _find_known(session: Session, collection: str, digest: str) -> ScanRow | None:
    query = select(ScanRow).where(
        ScanRow.digest == digest, ScanRow.collection == collection, ScanRow.deleted_at.is_(None)
    )
    return session.scalars(query.order_by(ScanRow.created_at).limit(1)).one_or_none()


def _add_one(
    database: Database, storage: Storage, path: Path, columns: dict[str, Any], account_id: uuid.UUID, moves: bool
) -> tuple[ScanRow, bool]:
    """Gives the scan and whether it is new. The file first, then its row; without the row no file."""
    from tracker import read_scan
    from tracker.capture import find_unit

    digest = compute_digest(path)
    with database.reading() as session:
        if (known := _find_known(session, columns["collection"], digest)) is not None:
            return known, False
    scan, said = read_scan(path), columns["metres_per_unit"]
    unit = find_unit(path, scan, said)
    scan = scan.scaled(unit)
    flags = find_flags(scan, ScanCrop(strokes=[]))
    size = measure_kept(scan, flags)
    scan_id = uuid.uuid4()
    file = f"scan{path.suffix.lower()}"
    destination = storage.folder(AREA, scan_id)
    destination.mkdir()
    try:
        if moves:
            os.replace(path, destination / file)
        else:
            shutil.copyfile(path, destination / file)
        row = ScanRow(
            id=scan_id,
            file=file,
            digest=digest,
            byte_count=(destination / file).stat().st_size,
            point_count=len(scan.points),
            face_count=0 if scan.faces is None else len(scan.faces),
            has_colors=scan.colors is not None,
            extent_m=[float(value) for value in scan.points.max(axis=0) - scan.points.min(axis=0)],
            size_m=size,
            first_metres_per_unit=unit,
            is_unit_guessed=said is None,
            notes=[],
            removed_count=int(np.count_nonzero(flags)),
            created_by=account_id,
            **columns | {"metres_per_unit": unit},
        )
        storage.publish(AREA, scan_id)
        with database.writing() as session:
            if (known := _find_known(session, columns["collection"], digest)) is None:
                session.add(row)
                record_act(session, account_id, "scan.add", "scan", scan_id, name=row.name)
                return row, True
    except BaseException:
        storage.remove(AREA, scan_id)
        raise
    storage.remove(AREA, scan_id)
    return known, False
