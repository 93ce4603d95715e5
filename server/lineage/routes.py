"""`/lineage`."""

from __future__ import annotations

import uuid

from fastapi import APIRouter

from server.access.service import AccountIdDep
from server.database import SessionDep
from server.errors import error_responses
from server.lineage import service
from server.lineage.schemas import Kind, Lineage

router = APIRouter(prefix="/lineage", tags=["curation"], responses=error_responses(404))


@router.get("/{kind}/{id}")
def get_lineage(kind: Kind, id: uuid.UUID, session: SessionDep, account_id: AccountIdDep) -> Lineage:
    """From scan to model, by registration and decision: where a thing comes from, what came of it."""
    return service.find_lineage(session, kind, id, account_id)
