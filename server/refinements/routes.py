"""`/sequences/{sequence_id}/refinements` and `/refinements/{refinement_id}`."""

from __future__ import annotations

import uuid

from fastapi import APIRouter

from server.access.service import LeadAccount
from server.database import DatabaseDep, SessionDep
from server.errors import error_responses
from server.refinements import service
from server.refinements.models import RefinementRow
from server.refinements.schemas import RefinementCreate, RefinementOut
from server.storage import StorageDep

router = APIRouter(tags=["refinements"], responses=error_responses(404))


@router.get("/sequences/{sequence_id}/refinements")
def list_refinements(sequence_id: uuid.UUID, session: SessionDep) -> list[RefinementOut]:
    """Refined cameras of a recording, the newest first, at most 20."""
    return [_describe(row, is_current) for row, is_current in service.list_refinements(session, sequence_id)]


@router.post("/sequences/{sequence_id}/refinements", status_code=201, responses=error_responses(422))
def create_refinement(
    sequence_id: uuid.UUID, body: RefinementCreate, database: DatabaseDep, storage: StorageDep, lead: LeadAccount
) -> RefinementOut:
    """Refine a recording's cameras by the joints labelled in two or more of them. The recording stays as it is."""
    return _describe(service.propose(database, storage, sequence_id, body.lenses, lead.id), True)


@router.post("/refinements/{refinement_id}/take", responses=error_responses(409))
def take_refinement(
    refinement_id: uuid.UUID, database: DatabaseDep, storage: StorageDep, lead: LeadAccount
) -> RefinementOut:
    """Give the recording these cameras; those it had are kept. Earlier tracks stay as they are."""
    return _describe(service.take(database, storage, refinement_id, lead.id), True)


@router.post("/refinements/{refinement_id}/put-back", responses=error_responses(409))
def put_refinement_back(
    refinement_id: uuid.UUID, database: DatabaseDep, storage: StorageDep, lead: LeadAccount
) -> RefinementOut:
    """Give the recording the cameras that it had before these were taken."""
    return _describe(service.put_back(database, storage, refinement_id, lead.id), True)


def _describe(row: RefinementRow, is_current: bool) -> RefinementOut:
    return RefinementOut.model_validate({**{name: getattr(row, name) for name in _FIELDS}, "is_current": is_current})


_FIELDS = RefinementOut.model_fields.keys() - {"is_current"}
