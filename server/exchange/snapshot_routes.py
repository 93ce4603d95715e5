"""Snapshots of a recording's labels."""

from __future__ import annotations

import uuid
from typing import Annotated, Literal

from fastapi import APIRouter, Query, Response

from server.access.service import CurrentAccount, LeadAccount
from server.annotations import snapshots
from server.annotations.restore_snapshot import restore_snapshot
from server.annotations.service import load_annotations
from server.database import SessionDep
from server.database.paging import Cursor, Limit, Page
from server.download import name_download
from server.errors import InvalidError, error_responses
from server.exchange.comparison import compare_labels
from server.exchange.describe import describe_comparison, describe_snapshots
from server.exchange.label_sets import check_sees_all, keep_visible
from server.exchange.schemas import (
    LabelComparison,
    SnapshotCreate,
    SnapshotOut,
    SnapshotRestored,
    SnapshotVerification,
)
from server.sequences.service import get_sequence
from server.storage import StorageDep

router = APIRouter(tags=["labels"], responses=error_responses(404))


@router.get("/sequences/{sequence_id}/labels/snapshots")
def list_snapshots(
    sequence_id: uuid.UUID, session: SessionDep, cursor: Cursor = None, limit: Limit = 100
) -> Page[SnapshotOut]:
    """Snapshots of a recording's labels, newest first."""
    sequence = get_sequence(session, sequence_id)
    rows, next_cursor = snapshots.list_snapshots(session, sequence.id, cursor, limit)
    return Page(items=describe_snapshots(session, rows), next_cursor=next_cursor)


@router.post("/sequences/{sequence_id}/labels/snapshots", status_code=201, responses={200: {"model": SnapshotOut}})
def create_snapshot(
    sequence_id: uuid.UUID,
    body: SnapshotCreate,
    session: SessionDep,
    storage: StorageDep,
    account: CurrentAccount,
    response: Response,
) -> SnapshotOut:
    """Keep the labels as they are now. The same labels are kept once: 200 and the snapshot that holds them already."""
    sequence = get_sequence(session, sequence_id)
    row, is_new = snapshots.create_snapshot(session, storage, sequence, body.name, account.id)
    response.status_code = 201 if is_new else 200
    return describe_snapshots(session, [row])[0]


@router.get("/snapshots/{snapshot_id}")
def get_snapshot(snapshot_id: uuid.UUID, session: SessionDep) -> SnapshotOut:
    """One snapshot."""
    return describe_snapshots(session, [snapshots.get_snapshot(session, snapshot_id)])[0]


@router.get(
    "/snapshots/{snapshot_id}/labels.json",
    response_class=Response,
    responses={200: {"content": {"application/json": {}}}, **error_responses(403, 409)},
)
def download_snapshot(
    snapshot_id: uuid.UUID, session: SessionDep, storage: StorageDep, account: CurrentAccount
) -> Response:
    """The file, as `annotations.json` of a recording folder; its SHA-256 is `content_hash`."""
    row = snapshots.get_snapshot(session, snapshot_id)
    check_sees_all(session, account, row.sequence_id)
    recording = get_sequence(session, row.sequence_id, deleted_too=True).name
    what = f"labels-v{row.version}-{row.content_hash[:12]}"
    headers = name_download(recording, what, suffix=".json") | {"ETag": f'"{row.content_hash}"'}
    return Response(snapshots.read_snapshot_bytes(storage, row), media_type="application/json", headers=headers)


@router.get("/snapshots/{snapshot_id}/verify")
def verify_snapshot(snapshot_id: uuid.UUID, session: SessionDep, storage: StorageDep) -> SnapshotVerification:
    """Compare the file with its SHA-256."""
    row = snapshots.get_snapshot(session, snapshot_id)
    checked = snapshots.verify_snapshot(storage, row)
    return SnapshotVerification(is_intact=checked.is_intact, expected=row.content_hash, found=checked.found)


@router.get("/snapshots/{snapshot_id}/compare", responses=error_responses(409))
def compare_snapshot(
    snapshot_id: uuid.UUID,
    session: SessionDep,
    storage: StorageDep,
    account: CurrentAccount,
    with_: Annotated[
        uuid.UUID | Literal["now"], Query(alias="with", description="`now`, or a later or earlier snapshot.")
    ] = "now",
) -> LabelComparison:
    """What changed from this snapshot to another one or to the current labels, joint by joint."""
    row = snapshots.get_snapshot(session, snapshot_id)
    before = snapshots.read_snapshot(storage, row)
    if with_ == "now":
        after = load_annotations(session, row.sequence_id)
    else:
        other = snapshots.get_snapshot(session, with_)
        if other.sequence_id != row.sequence_id:
            raise InvalidError("The two snapshots are of different recordings; compare two of the same one.")
        after = snapshots.read_snapshot(storage, other)
    before, after = (keep_visible(session, account, row.sequence_id, labels) for labels in (before, after))
    return describe_comparison(compare_labels(before, after))


@router.post("/snapshots/{snapshot_id}/restore", responses=error_responses(403, 409))
def restore(snapshot_id: uuid.UUID, session: SessionDep, storage: StorageDep, account: LeadAccount) -> SnapshotRestored:
    """Make its labels the current ones again, as new revisions. What was there is kept as the snapshot `before`."""
    row = snapshots.get_snapshot(session, snapshot_id)
    sequence = get_sequence(session, row.sequence_id)
    done = restore_snapshot(session, storage, sequence, row, account)
    return SnapshotRestored(
        changed=done.changed, deleted=done.deleted, before=describe_snapshots(session, [done.before])[0]
    )
