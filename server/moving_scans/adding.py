"""Files become a moving scan: in the order of their names, one a frame; a file that cannot be used keeps its place."""

from __future__ import annotations

import hashlib
import os
import re
import uuid
from collections.abc import Iterator
from pathlib import Path, PurePosixPath

from sqlalchemy import select
from sqlalchemy.orm import Session

from server.access.audit import record_act
from server.compute import Compute
from server.database import Database
from server.errors import InvalidError, TooLargeError
from server.moving_scans.frame_files import FrameRead, read_frames
from server.moving_scans.models import MovingScanRow
from server.moving_scans.schemas import MovingScanOptions
from server.scans.folder import find_scans
from server.storage import Storage
from tracker import say_count

AREA = "moving_scans"
MOST_FRAMES = 5000
AT_ONCE = 16
"""Frames that are read in one question to the process that computes: others get their turn in between."""


def add_moving_scan(
    database: Database,
    storage: Storage,
    compute: Compute,
    folder: Path,
    fallback: str,
    options: MovingScanOptions,
    account_id: uuid.UUID,
) -> tuple[MovingScanRow, bool]:
    """Move the scans of a folder into the studio as the frames of one moving scan.

    Args:
        folder: Of an upload; its files are moved away.
        fallback: A name, when neither somebody nor the folder says one.

    Returns:
        The row, and whether it is new: the same files in the same order are kept once.

    Raises:
        InvalidError: No file in it can be used.
    """
    found = find_scans(folder)
    names = sorted(found.scans, key=order_naturally)
    if len(names) > MOST_FRAMES:
        raise TooLargeError(f"{len(names)} scans; a moving scan takes {MOST_FRAMES}. Cut it into parts.")
    id_ = uuid.uuid4()
    place = storage.folder(AREA, id_)
    place.mkdir()
    try:
        files = [f"{frame:06d}{found.scans[name].suffix.lower()}" for frame, name in enumerate(names)]
        for name, file in zip(names, files, strict=True):
            os.replace(found.scans[name], place / file)
        reads = _read_all(compute, place, files, options.metres_per_unit)
        row = _make_row(id_, names, files, reads, options, found.write_notes())
        row.name, row.created_by = options.name or _find_name(names) or fallback, account_id
        row.byte_count = sum((place / file).stat().st_size for file in files)
        with database.reading() as session:
            if (known := _find_known(session, row.digest)) is not None:
                storage.remove(AREA, id_)
                return known, False
        storage.publish(AREA, id_)
        with database.writing() as session:
            session.add(row)
            record_act(session, account_id, "moving_scan.add", "moving_scan", id_, name=row.name)
        return row, True
    except BaseException:
        storage.remove(AREA, id_)
        raise


def order_naturally(name: str) -> list[tuple[int, str]]:
    """A key that puts frame2 before frame10; names with leading zeros keep their order."""
    parts = re.split(r"(\d+)", name.casefold())
    return [(int(part[:18]), "") if part.isdecimal() and part.isascii() else (-1, part) for part in parts]


def _read_all(compute: Compute, place: Path, files: list[str], said: float | None) -> list[FrameRead]:
    reads: list[FrameRead] = []
    for some in _cut(list(enumerate(files))):
        unit = said or next((read.metres_per_unit for read in reads if read.metres_per_unit is not None), None)
        reads += compute.ask(read_frames, place, some, unit)
    return reads


def _cut(files: list[tuple[int, str]]) -> Iterator[list[tuple[int, str]]]:
    return (files[first : first + AT_ONCE] for first in range(0, len(files), AT_ONCE))


def _make_row(
    id_: uuid.UUID,
    names: list[str],
    files: list[str],
    reads: list[FrameRead],
    options: MovingScanOptions,
    notes: list[str],
) -> MovingScanRow:
    usable = [read for read in reads if read.problem is None]
    if not usable:
        more = f" ({say_count(len(names) - 1, 'other')} likewise.)" if len(names) > 1 else ""
        raise InvalidError(f"None of the scans can be used. {names[0][:200]}: {reads[0].problem}{more}")
    unit = usable[0].metres_per_unit
    assert unit is not None
    low = [min(read.low[axis] for read in usable) for axis in range(3)]
    high = [max(read.high[axis] for read in usable) for axis in range(3)]
    frames = [
        {"file": file, "name": name[-300:], "digest": read.digest, "point_count": read.point_count}
        | {"problem": read.problem}
        for name, file, read in zip(names, files, reads, strict=True)
    ]
    return MovingScanRow(
        id=id_,
        subject=options.subject,
        fps=options.fps,
        frames=frames,
        frame_count=len(frames),
        usable_count=len(usable),
        digest=hashlib.sha256("".join(read.digest for read in reads).encode()).hexdigest(),
        metres_per_unit=unit,
        is_unit_guessed=options.metres_per_unit is None,
        box_m=[low, high],
        notes=notes,
    )


def _find_name(names: list[str]) -> str:
    """Of the folder that all files lie in, if they do."""
    folders = {PurePosixPath(name).parent for name in names}
    name = next(iter(folders)).name if len(folders) == 1 else ""
    return "".join(letter for letter in name if letter.isprintable()).strip()[:200]


def _find_known(session: Session, digest: str) -> MovingScanRow | None:
    query = select(MovingScanRow).where(MovingScanRow.digest == digest, MovingScanRow.deleted_at.is_(None))
    return session.scalars(query.order_by(MovingScanRow.created_at).limit(1)).one_or_none()
