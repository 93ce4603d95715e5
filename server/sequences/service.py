"""Recordings: what can be done with their rows."""

from __future__ import annotations

import dataclasses
import uuid
from collections.abc import Sequence as Many
from typing import Any

from sqlalchemy import select, update
from sqlalchemy.orm import Session

from server.database import utc_now
from server.database.paging import fetch_page
from server.database.texts import match_words
from server.errors import ConflictError, NotFoundError
from server.sequences.content_key import compute_content_key
from server.sequences.depth_range import measure_depth_range
from server.sequences.models import SequenceRow
from server.sequences.schemas import SequencePatch
from server.storage import Storage
from tracker import Sequence, load_sequence, save_sequence_json

AREA = "sequences"


def describe_recording(recording: Sequence) -> dict[str, Any]:
    """Columns of a recording's row, found in its files. Reads all of them: not for inside a transaction."""
    return {
        "name": recording.name,
        "fps": recording.fps,
        "frame_count": recording.frame_count,
        "cameras": [_describe_camera(recording, camera.id) for camera in recording.cameras],
        "hands": list(recording.hands),
        "objects": [{"name": item.name} for item in recording.objects],
        "content_key": compute_content_key(recording),
    }


def _describe_camera(recording: Sequence, camera_id: str) -> dict[str, Any]:
    camera = recording.camera(camera_id)
    near, far = measure_depth_range(recording, camera_id) if camera.has_depth else (None, None)
    return {
        "id": camera.id,
        "width": camera.width,
        "height": camera.height,
        "K": camera.K.tolist(),
        "distortion": [float(value) for value in camera.distortion],
        "T_world_camera": camera.T_world_camera.tolist(),
        "has_color": camera.has_color,
        "has_depth": camera.has_depth,
        "depth_scale": camera.depth_scale if camera.has_depth else None,
        "depth_near": near,
        "depth_far": far,
    }


def add_sequence(
    session: Session, id_: uuid.UUID, columns: dict[str, Any], report: dict[str, Any] | None, account_id: uuid.UUID
) -> SequenceRow:
    """Add the row of a recording whose files are in their place already."""
    row = SequenceRow(id=id_, report=report, created_by=account_id, **columns)
    session.add(row)
    session.flush()
    return row


def list_sequences(
    session: Session, search: str | None, cursor: str | None, limit: int
) -> tuple[Many[SequenceRow], str | None]:
    """Newest first; with `search`, those whose name holds each of its words, upper and lower case alike."""
    query = select(SequenceRow).where(SequenceRow.deleted_at.is_(None), *match_words(search, SequenceRow.name))
    return fetch_page(session, query, (SequenceRow.created_at, SequenceRow.id), cursor, limit)


def get_sequence(session: Session, id_: uuid.UUID, *, deleted_too: bool = False) -> SequenceRow:
    """The recording of this id."""
    row = session.get(SequenceRow, id_)
    if row is None or (row.deleted_at is not None and not deleted_too):
        gone = "was deleted; it can be restored" if row is not None else "does not exist"
        raise NotFoundError(f"The recording {id_} {gone}.")
    return row


def open_sequence(storage: Storage, id_: uuid.UUID) -> Sequence:
    """The files of a recording."""
    return load_sequence(storage.folder(AREA, id_))


def update_sequence(
    session: Session, storage: Storage, row: SequenceRow, patch: SequencePatch, revision: int
) -> SequenceRow:
    """Change a recording, if it is still the revision given; its `sequence.json` follows."""
    changes = {name: value for name, value in patch.model_dump(exclude_unset=True).items() if value is not None}
    statement = (
        update(SequenceRow)
        .where(SequenceRow.id == row.id, SequenceRow.revision == revision)
        .values(**changes, revision=revision + 1, updated_at=utc_now())
        .execution_options(synchronize_session=False)
    )
    if session.connection().execute(statement).rowcount != 1:
        session.refresh(row)
        raise StaleSequenceError(row)
    session.refresh(row)
    recording = open_sequence(storage, row.id)
    save_sequence_json(dataclasses.replace(recording, name=row.name, hands=tuple(row.hands)))
    storage.publish(AREA, row.id)
    return row


def describe_places(cameras: Many[Any]) -> list[dict[str, Any]]:
    """Of cameras as rows and `sequence.json` have them what calibrates them: lens and place."""
    return [{name: camera[name] for name in ("K", "distortion", "T_world_camera")} for camera in cameras]


def change_cameras(
    session: Session, storage: Storage, row: SequenceRow, recording: Sequence, content_key: str, revision: int
) -> None:
    """Give a recording lenses and places of `recording`'s cameras, if it is still the revision given.

    Its `sequence.json` follows, and so does its content key: whatever was computed from the old cameras is another
    thing. The caller computes the key before the transaction, as that reads every file.
    """
    places = describe_places([camera.to_json() for camera in recording.cameras])
    cameras = [camera | place for camera, place in zip(row.cameras, places, strict=True)]
    statement = (
        update(SequenceRow)
        .where(SequenceRow.id == row.id, SequenceRow.revision == revision)
        .values(cameras=cameras, content_key=content_key, revision=revision + 1, updated_at=utc_now())
        .execution_options(synchronize_session=False)
    )
    if session.connection().execute(statement).rowcount != 1:
        session.refresh(row)
        raise StaleSequenceError(row)
    session.refresh(row)
    save_sequence_json(dataclasses.replace(recording, name=row.name, hands=tuple(row.hands)))
    storage.publish(AREA, row.id)


class StaleSequenceError(ConflictError):
    """Somebody changed the recording meanwhile; `row` is how it is now."""

    def __init__(self, row: SequenceRow) -> None:
        super().__init__(f"The recording was changed meanwhile and is at revision {row.revision}. Load it again.")
        self.row = row


def delete_sequence(session: Session, row: SequenceRow) -> None:
    """Hide a recording; `restore_sequence` undoes it. Its files stay."""
    row.deleted_at = utc_now()
    session.flush()


def restore_sequence(session: Session, row: SequenceRow) -> None:
    """Undo a deletion; nothing happens when there was none."""
    row.deleted_at = None
    session.flush()
