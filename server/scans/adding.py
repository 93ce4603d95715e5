"""Files become scans: each by itself, so that one that is damaged keeps no other out.

Files are read for milliseconds to seconds each, so the functions take the database and keep transactions short.
"""

from __future__ import annotations

import json
import os
import shutil
import uuid
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError
from sqlalchemy import select
from sqlalchemy.orm import Session

from server.accounts.audit import record_act
from server.database import Database
from server.database.texts import Label, Name
from server.errors import InvalidError, StudioError
from server.scans.cropping import find_flags
from server.scans.models import ScanRow
from server.scans.schemas import ScanCrop, ScanRefusal, Side, UnitScale
from server.scans.service import AREA
from server.storage import Storage
from server.storage.digest import compute_digest

SUFFIXES = (".ply", ".obj", ".stl")
LIST_NAME = "scans.json"
MAX_LIST_BYTES = 64 * 2**20


class ScanOptions(BaseModel):
    """What files do not tell; `scans.json` wins over it."""

    model_config = ConfigDict(extra="forbid")

    collection: Name = "scans"
    subject: Label = ""
    pose: Label = ""
    side: Side | None = None
    metres_per_unit: UnitScale | None = None


class ListedScan(BaseModel):
    """A line of `scans.json`."""

    model_config = ConfigDict(extra="ignore")

    file: str = Field(max_length=1000)
    name: Name | None = None
    subject: Label = ""
    pose: Label = ""
    side: Side | None = None
    metres_per_unit: UnitScale | None = None


@dataclass
class Added:
    """What became of some files."""

    added: list[ScanRow] = field(default_factory=list)
    known: list[ScanRow] = field(default_factory=list)
    refused: list[ScanRefusal] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)


def parse_options(text: str) -> ScanOptions:
    """Options from a form's field: a JSON object, or nothing."""
    if not text.strip():
        return ScanOptions()
    try:
        options = json.loads(text)
    except (ValueError, RecursionError):
        options = None
    if not isinstance(options, dict):
        raise InvalidError(f"The field `options` is {text[:80]!r}; needed a JSON object.")
    return make_options(options)


def make_options(options: dict[str, Any]) -> ScanOptions:
    """Options that somebody gave; raises for what they cannot be."""
    try:
        return ScanOptions.model_validate(options)
    except ValidationError as fault:
        first = fault.errors()[0]
        place = ".".join(str(part) for part in first["loc"]) or "the options"
        raise InvalidError(f"{place}: {first['msg']} (got {str(first['input'])[:80]!r}).") from None


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
    done = Added()
    paths = [folder] if folder.is_file() else sorted(path for path in folder.rglob("*") if path.is_file())
    root = folder.parent if folder.is_file() else folder
    listed = _read_lists([path for path in paths if path.name == LIST_NAME], root)
    scans = [path for path in paths if path.suffix.lower() in SUFFIXES]
    if not scans:
        raise InvalidError(
            f"There are no scans in it; needed files that end in {', '.join(SUFFIXES)}, or a zip of them."
        )
    for path in scans:
        name = path.relative_to(root).as_posix()
        line = listed.pop(name, None)
        try:
            row, is_new = _add_one(database, storage, path, _describe(name, line, options), account_id, moves)
        except StudioError as fault:
            done.refused.append(ScanRefusal(file=name, detail=fault.detail))
        except Exception as fault:
            from tracker import TrackerError

            if not isinstance(fault, TrackerError):
                raise
            done.refused.append(ScanRefusal(file=name, detail=str(fault).replace(f"{root}/", "")))
        else:
            (done.added if is_new else done.known).append(row)
    if listed:
        done.notes.append(
            f"{LIST_NAME} names {len(listed)} files that are not there, such as {next(iter(listed))[:200]!r}."
        )
    if others := len(paths) - len(scans) - sum(path.name == LIST_NAME for path in paths):
        done.notes.append(f"{others} other files were left aside.")
    return done


def _read_lists(paths: Iterable[Path], root: Path) -> dict[str, ListedScan]:
    """Lines of every `scans.json`, by the path of the file from the root."""
    found: dict[str, ListedScan] = {}
    for path in paths:
        name = path.relative_to(root).as_posix()
        if path.stat().st_size > MAX_LIST_BYTES:
            raise InvalidError(f"{name} has more than {MAX_LIST_BYTES} bytes.")
        try:
            document = json.loads(path.read_bytes())
            lines = document["scans"] if isinstance(document, dict) else document
            read = [ListedScan.model_validate(line) for line in lines]
        except (ValueError, KeyError, TypeError, RecursionError) as fault:
            raise InvalidError(
                f"{name} cannot be read: {str(fault)[:300]} Needed a list of objects with `file`, and `subject`, "
                "`pose`, `side` (right or left) and `metres_per_unit` where they are known."
            ) from None
        base = path.parent.relative_to(root).as_posix()
        found |= {line.file if base == "." else f"{base}/{line.file}": line for line in read}
    return found


def _describe(name: str, line: ListedScan | None, options: ScanOptions) -> dict[str, Any]:
    line = line or ListedScan(file=name)
    stem = "".join(c for c in Path(name).with_suffix("").as_posix() if c.isprintable()).strip()[-200:]
    return {
        "name": line.name or stem or "scan",
        "collection": options.collection,
        "subject": line.subject or options.subject,
        "pose": line.pose or options.pose,
        "side": line.side or options.side,
        "metres_per_unit": line.metres_per_unit or options.metres_per_unit,
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
    from tracker import load_scan

    digest = compute_digest(path)
    with database.reading() as session:
        if (known := _find_known(session, columns["collection"], digest)) is not None:
            return known, False
    scan = load_scan(path, columns["metres_per_unit"])
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
            notes=[],
            removed_count=int(np.count_nonzero(find_flags(scan, ScanCrop(strokes=[])))),
            created_by=account_id,
            **columns,
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
