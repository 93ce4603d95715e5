"""Refined cameras: what can be done with their rows, and with the recordings they are of."""

from __future__ import annotations

import dataclasses
import uuid
from collections.abc import Sequence as Many
from typing import Any

import numpy as np
from sqlalchemy import select
from sqlalchemy.orm import Session

from server.access.audit import record_act
from server.annotations.service import load_annotations
from server.database import Database, utc_now
from server.errors import ConflictError, InvalidError, NotFoundError
from server.jobs.service import JobFilter, list_jobs
from server.refinements.models import RefinementRow
from server.sequences.content_key import compute_content_key
from server.sequences.service import change_cameras, describe_places, get_sequence, open_sequence
from server.storage import Storage
from tracker import refine_cameras

KEPT = 20
"""Proposals listed of a recording, the newest first."""


def list_refinements(session: Session, sequence_id: uuid.UUID) -> list[tuple[RefinementRow, bool]]:
    """Refined cameras of a recording, the newest first, and whether the recording has their cameras now."""
    sequence = get_sequence(session, sequence_id)
    query = select(RefinementRow).where(RefinementRow.sequence_id == sequence_id)
    query = query.order_by(RefinementRow.created_at.desc(), RefinementRow.id.desc()).limit(KEPT)
    return [(row, is_current(row, sequence.cameras)) for row in session.scalars(query)]


def is_current(row: RefinementRow, cameras: Many[Any]) -> bool:
    """Whether a recording's cameras are those that this proposal was made from, or those that it gave."""
    told = row.cameras_after if row.state == "taken" else row.cameras_before
    return describe_places(told) == describe_places(cameras)


def propose(
    database: Database, storage: Storage, sequence_id: uuid.UUID, lenses: bool, account_id: uuid.UUID
) -> RefinementRow:
    """Refine a recording's cameras by its labels as they are now. The recording stays as it is.

    Raises:
        CalibrationError: The labels are too few to say anything.
    """
    with database.reading() as session:
        before = get_sequence(session, sequence_id).cameras
        labels = load_annotations(session, sequence_id)
    recording = open_sequence(storage, sequence_id)
    found = refine_cameras(recording.cameras, labels, lenses)
    after = [
        old
        | {"K": new.K.tolist(), "distortion": new.distortion.tolist(), "T_world_camera": new.T_world_camera.tolist()}
        for old, new in zip(before, found.cameras, strict=True)
    ]
    with database.writing() as session:
        row = RefinementRow(
            sequence_id=sequence_id,
            report=found.to_json(),
            cameras_before=before,
            cameras_after=after,
            created_by=account_id,
        )
        session.add(row)
        session.flush()
        session.expunge(row)
    return row


def take(database: Database, storage: Storage, id_: uuid.UUID, account_id: uuid.UUID) -> RefinementRow:
    """Give a recording the cameras of a proposal."""
    return _change(database, storage, id_, "taken", account_id)


def put_back(database: Database, storage: Storage, id_: uuid.UUID, account_id: uuid.UUID) -> RefinementRow:
    """Give a recording the cameras back that it had before a proposal was taken."""
    return _change(database, storage, id_, "put_back", account_id)


def _change(database: Database, storage: Storage, id_: uuid.UUID, state: str, account_id: uuid.UUID) -> RefinementRow:
    with database.reading() as session:
        row = _get(session, id_)
        revision = get_sequence(session, row.sequence_id).revision
        _check(session, row, state)
        cameras = row.cameras_after if state == "taken" else row.cameras_before
        sequence_id = row.sequence_id
    # Every file is read for the key: not for inside a transaction.
    before = open_sequence(storage, sequence_id)
    recording = dataclasses.replace(before, cameras=tuple(map(_give_place, before.cameras, cameras)))
    key = compute_content_key(recording)
    with database.writing() as session:
        row = _get(session, id_)
        _check(session, row, state)
        change_cameras(session, storage, get_sequence(session, sequence_id), recording, key, revision)
        row.state, row.changed_at, row.changed_by = state, utc_now(), account_id
        record_act(session, account_id, f"cameras.{state}", "recording", sequence_id, refinement=str(id_))
        session.flush()
        session.expunge(row)
    return row


def _give_place(camera: Any, told: dict[str, Any]) -> Any:
    places = {name: np.array(value, dtype=np.float64) for name, value in describe_places([told])[0].items()}
    return dataclasses.replace(camera, **places)


def _get(session: Session, id_: uuid.UUID) -> RefinementRow:
    row = session.get(RefinementRow, id_)
    if row is None:
        raise NotFoundError(f"There are no refined cameras {id_}.")
    return row


def _check(session: Session, row: RefinementRow, state: str) -> None:
    """Raise when a recording's cameras cannot become those of this row now."""
    if state == "taken" and row.report["refusal"]:
        raise InvalidError(f"The cameras stay as they are. {row.report['refusal']}")
    if (row.state == "taken") == (state == "taken"):
        said = "were taken already" if row.state == "taken" else "were not taken; there is nothing to put back"
        raise ConflictError(f"These cameras {said}.")
    if not is_current(row, get_sequence(session, row.sequence_id).cameras):
        raise ConflictError("The recording's cameras were changed meanwhile. Refine them again.")
    busy, _ = list_jobs(session, JobFilter(sequence_id=row.sequence_id, states=("queued", "running")), None, 1)
    if busy:
        raise ConflictError("A job of this recording is queued or running with its present cameras. Wait for its end.")
