"""A snapshot made the current labels again: as new revisions, with what was there kept in a snapshot before."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from sqlalchemy.orm import Session

from server.access.audit import record_act
from server.access.models import Account
from server.access.places import Place
from server.access.policy import check_change
from server.annotations.bulk import BulkChange, change_annotations, find_annotations
from server.annotations.snapshot_models import SnapshotRow
from server.annotations.snapshots import create_snapshot, read_snapshot
from server.annotations.sources import write_sources
from server.sequences.models import SequenceRow
from server.storage import Storage


@dataclass(frozen=True)
class Restored:
    """What a restore did.

    Attributes:
        changed: Hands that were written again.
        deleted: Hands that the snapshot did not have.
        before: What undoes it.
    """

    changed: int
    deleted: int
    before: SnapshotRow


def restore_snapshot(
    session: Session,
    storage: Storage,
    sequence: SequenceRow,
    snapshot: SnapshotRow,
    account: Account,
) -> Restored:
    """All of it or nothing: a place that is locked refuses the whole."""
    kept = {item.key: item for item in read_snapshot(storage, snapshot).items}
    wanted = {key: item.to_json()["points"] for key, item in kept.items()}
    before, _ = create_snapshot(
        session, storage, sequence, f"Before version {snapshot.version} was restored", account.id
    )
    held = find_annotations(session, sequence.id, hold=True)
    current: dict[Any, Any] = {key: row.points for key, row in held.items() if row.points is not None}
    changes = []
    for key in sorted(wanted.keys() | current.keys()):
        if wanted.get(key) != current.get(key):
            frame, camera, hand = key
            place = Place(sequence.id, camera, frame, hand)
            check_change(session, account, place)
            if key in kept:
                changes.append(BulkChange(place, "restore", wanted[key], write_sources(kept[key].sources)))
            else:
                changes.append(BulkChange(place, "delete", None))
    change_annotations(session, held, changes, account.id)
    deleted = sum(change.points is None for change in changes)
    record_act(
        session, account.id, "snapshot.restore", "snapshot", snapshot.id, version=snapshot.version, changed=len(changes)
    )
    return Restored(len(changes) - deleted, deleted, before)
