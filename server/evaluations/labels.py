"""The labels that judge: the current ones, or a snapshot that never changes."""

from __future__ import annotations

import hashlib
import json
import uuid
from dataclasses import dataclass
from typing import Any

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from server.annotations.models import AnnotationRow
from server.annotations.service import load_annotations
from server.annotations.snapshot_models import SnapshotRow
from server.errors import InvalidError, NotFoundError
from server.storage import Storage
from tracker import Annotations
from tracker import load_annotations as read_annotations


@dataclass(frozen=True)
class LabelsId:
    """Which labels of a recording; two of the same key hold the same joints.

    Attributes:
        sequence_id: Of the recording.
        key: Names the labels for good: `now-<revision>` or `snapshot-<id>`.
        revision: Changes ever made to the recording's labels; None of a snapshot.
        snapshot: Its row; None of the labels of now.
    """

    sequence_id: uuid.UUID
    key: str
    revision: int | None
    snapshot: SnapshotRow | None = None


@dataclass(frozen=True, eq=False)
class Labels:
    """Annotations and where they come from."""

    annotations: Annotations
    facts: dict[str, Any]


def find_current_labels(session: Session, sequence_id: uuid.UUID) -> LabelsId:
    """The labels of now. Every change of an annotation raises one revision, so their sum counts the changes."""
    query = select(func.coalesce(func.sum(AnnotationRow.revision), 0)).where(
        AnnotationRow.sequence_id == sequence_id, AnnotationRow.replica == ""
    )
    revision = int(session.scalar(query) or 0)
    return LabelsId(sequence_id, f"now-{revision}", revision)


def find_snapshots(session: Session, ids: list[uuid.UUID]) -> dict[uuid.UUID, LabelsId]:
    """Snapshots by the recording they are of, one of each."""
    query = select(SnapshotRow).where(SnapshotRow.id.in_(ids)).order_by(SnapshotRow.version)
    rows = session.scalars(query).all() if ids else []
    if missing := set(ids) - {row.id for row in rows}:
        raise NotFoundError(f"There is no snapshot {min(missing)}. Choose one of the recording's snapshots, or none.")
    chosen: dict[uuid.UUID, SnapshotRow] = {}
    for row in rows:
        if (other := chosen.setdefault(row.sequence_id, row)) is not row:
            raise InvalidError(
                f"The snapshots {other.name!r} and {row.name!r} are of one recording, which one of them judges. Leave "
                "the other one out."
            )
    return {key: LabelsId(key, f"snapshot-{row.id}", None, row) for key, row in chosen.items()}


def read_labels(session: Session, storage: Storage, which: LabelsId) -> Labels:
    """The labels themselves."""
    row = which.snapshot
    if row is None:
        annotations = load_annotations(session, which.sequence_id)
        text = json.dumps(annotations.to_json(), separators=(",", ":")) + "\n"
        return Labels(
            annotations,
            {
                "kind": "now",
                "revision": which.revision,
                "sha256": hashlib.sha256(text.encode()).hexdigest(),
                "items": len(annotations.items),
            },
        )
    path = storage.document("snapshots", row.id)
    if not path.is_file() or hashlib.sha256(path.read_bytes()).hexdigest() != row.content_hash:
        raise NotFoundError(
            f"The file of the snapshot {row.name!r} is missing or damaged. Judge by another one, or by today's labels."
        )
    return Labels(
        read_annotations(path),
        {
            "kind": "snapshot",
            "snapshot_id": str(row.id),
            "version": row.version,
            "name": row.name,
            "sha256": row.content_hash,
            "items": row.item_count,
        },
    )
