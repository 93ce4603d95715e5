"""`/bin`."""

from __future__ import annotations

import uuid
from typing import Annotated

from fastapi import APIRouter, Query

from server.access.service import LeadAccount
from server.bin import erasing, service
from server.bin.schemas import BinErasure, BinItem
from server.database import DatabaseDep, SessionDep
from server.database.paging import Cursor, Limit, Page
from server.errors import error_responses
from server.storage import StorageDep

router = APIRouter(prefix="/bin", tags=["bin"], responses=error_responses(404))


@router.get("")
def list_bin(
    session: SessionDep,
    storage: StorageDep,
    lead: LeadAccount,
    kind: Annotated[str | None, Query(max_length=40, description="Such as `scan`.")] = None,
    cursor: Cursor = None,
    limit: Limit = 50,
) -> Page[BinItem]:
    """What was deleted, the last first. Nothing leaves the bin by itself."""
    items, next_cursor = service.list_bin(session, storage, kind, cursor, limit)
    return Page(items=items, next_cursor=next_cursor)


@router.post("/{kind}/{item_id}/restore", status_code=204, responses=error_responses(409))
def restore_from_bin(kind: str, item_id: uuid.UUID, session: SessionDep, lead: LeadAccount) -> None:
    """Restore a deleted thing. 409 when what it belongs to is in the bin too: restore that first."""
    service.restore(session, lead, kind, item_id)


@router.get("/{kind}/{item_id}/erasure")
def describe_erasure(
    kind: str, item_id: uuid.UUID, session: SessionDep, storage: StorageDep, lead: LeadAccount
) -> BinErasure:
    """What else is deleted for good with a thing, and what prevents it, if something does."""
    return erasing.describe(session, storage, kind, item_id)


@router.delete("/{kind}/{item_id}", status_code=204, responses=error_responses(409))
def delete_for_good(
    kind: str, item_id: uuid.UUID, database: DatabaseDep, storage: StorageDep, lead: LeadAccount
) -> None:
    """Delete a thing in the bin for good, with its files and all that depends on it. It cannot be restored.

    409 while a job uses it, or when something that stays was made from it.
    """
    with database.writing() as session:
        left = erasing.erase(session, storage, lead, kind, item_id)
    erasing.remove_files(storage, left)
