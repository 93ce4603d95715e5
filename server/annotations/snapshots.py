"""Snapshots: labels as they were, in a file that never changes and whose name is its hash."""

from __future__ import annotations

import hashlib
import json
import uuid
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from sqlalchemy import func, select
from sqlalchemy.orm import Session

from server.access.audit import record_act
from server.annotations.service import load_annotations
from server.annotations.snapshot_models import SnapshotRow
from server.annotations.sources import read_sources
from server.database.paging import fetch_page
from server.errors import ConflictError, NotFoundError
from server.sequences.models import SequenceRow
from server.storage import Storage
from tracker import Annotation, Annotations

AREA = "snapshots"


class DamagedSnapshotError(ConflictError):
    """The file is not what it was when the snapshot was made."""


@dataclass(frozen=True)
class Verification:
    """Whether a snapshot's file is still what it was.

    Attributes:
        is_intact: Its hash is the one that was noted.
        found: Hash of the file now; None when it is gone.
    """

    is_intact: bool
    found: str | None


def write_canonical(annotations: Annotations) -> bytes:
    """`annotations.json` with the same bytes for the same labels, whatever the database or the machine."""
    return (json.dumps(annotations.to_json(), separators=(",", ":"), allow_nan=False) + "\n").encode()


def hold_sequences(session: Session, ids: Sequence[uuid.UUID]) -> None:
    """Have bulk changes of a recording's labels wait for each other, before they hold anything else.

    Not FOR UPDATE: that would make everybody wait who stores an annotation.
    """
    query = select(SequenceRow.id).where(SequenceRow.id.in_(ids)).order_by(SequenceRow.id)
    session.execute(query.with_for_update(key_share=True))


def create_snapshot(
    session: Session, storage: Storage, sequence: SequenceRow, name: str, account_id: uuid.UUID
) -> tuple[SnapshotRow, bool]:
    """Keep the labels as they are now. Gives the snapshot and whether it is new: the same labels are kept once."""
    hold_sequences(session, [sequence.id])
    annotations = load_annotations(session, sequence.id)
    data = write_canonical(annotations)
    digest = hashlib.sha256(data).hexdigest()
    same = select(SnapshotRow).where(SnapshotRow.sequence_id == sequence.id, SnapshotRow.content_hash == digest)
    if (known := session.scalars(same.order_by(SnapshotRow.version).limit(1)).one_or_none()) is not None:
        return known, False
    newest = session.scalar(select(func.max(SnapshotRow.version)).where(SnapshotRow.sequence_id == sequence.id)) or 0
    row = SnapshotRow(
        id=uuid.uuid4(),
        sequence_id=sequence.id,
        version=newest + 1,
        name=name,
        content_hash=digest,
        item_count=len(annotations.items),
        joint_count=sum(int((item.points[:, 2] > 0).sum()) for item in annotations.items),
        created_by=account_id,
    )
    storage.add_document(AREA, row.id, data)
    session.add(row)
    session.flush()
    record_act(session, account_id, "snapshot.create", "snapshot", row.id, version=row.version, sha256=digest)
    return row, True


def get_snapshot(session: Session, snapshot_id: uuid.UUID) -> SnapshotRow:
    """The snapshot of this id."""
    row = session.get(SnapshotRow, snapshot_id)
    if row is None:
        raise NotFoundError(f"There is no snapshot {snapshot_id}. Choose one of the recording's snapshots.")
    return row


def find_snapshot(session: Session, sequence_id: uuid.UUID, version: int) -> SnapshotRow:
    """A recording's snapshot of this version."""
    query = select(SnapshotRow).where(SnapshotRow.sequence_id == sequence_id, SnapshotRow.version == version)
    row = session.scalars(query).one_or_none()
    if row is None:
        raise NotFoundError(f"The recording has no snapshot of version {version}.")
    return row


def list_snapshots(
    session: Session, sequence_id: uuid.UUID, cursor: str | None, limit: int
) -> tuple[Sequence[SnapshotRow], str | None]:
    """Newest first."""
    query = select(SnapshotRow).where(SnapshotRow.sequence_id == sequence_id)
    return fetch_page(session, query, (SnapshotRow.version,), cursor, limit)


def verify_snapshot(storage: Storage, row: SnapshotRow) -> Verification:
    """Hash the file again."""
    try:
        found = hashlib.sha256(storage.document(AREA, row.id).read_bytes()).hexdigest()
    except FileNotFoundError:
        return Verification(False, None)
    return Verification(found == row.content_hash, found)


def read_snapshot_bytes(storage: Storage, row: SnapshotRow) -> bytes:
    """The file; raises when it is not what it was."""
    try:
        data = storage.document(AREA, row.id).read_bytes()
    except FileNotFoundError:
        raise DamagedSnapshotError(
            f"The file of the snapshot {row.name!r} (version {row.version}) is missing in the studio's data folder; "
            f"restore {AREA}/{row.id}.json from a backup. The current labels are not affected."
        ) from None
    if (found := hashlib.sha256(data).hexdigest()) != row.content_hash:
        raise DamagedSnapshotError(
            f"The file of the snapshot {row.name!r} (version {row.version}) is damaged: its SHA-256 is {found[:12]}, "
            f"expected {row.content_hash[:12]}. Restore {AREA}/{row.id}.json from a backup."
        )
    return data


def read_snapshot(storage: Storage, row: SnapshotRow) -> Annotations:
    """The labels in a snapshot; its hash says that they are what we wrote."""
    document = json.loads(read_snapshot_bytes(storage, row))
    return Annotations(
        tuple(
            Annotation(
                item["frame"],
                item["camera"],
                item["hand"],
                np.array(item["points"], dtype=np.float64),
                read_sources(item.get("sources")),
            )
            for item in document["items"]
        )
    )
