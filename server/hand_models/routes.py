"""`/hand-skeleton`, `/hand-models`."""

from __future__ import annotations

import uuid

from fastapi import APIRouter

from server.accounts.audit import record_act
from server.accounts.service import LeadAccount
from server.database import SessionDep
from server.database.paging import Cursor, Limit, Page
from server.errors import NotFoundError, error_responses
from server.hand_models import service, storing
from server.hand_models.schemas import HandModelOut, HandModelReport, HandSkeleton
from tracker import HAND_EDGES, HAND_JOINTS

router = APIRouter(tags=["hands"], responses=error_responses())


@router.get("/hand-skeleton")
def get_hand_skeleton() -> HandSkeleton:
    """Joints of a hand and how they hang together."""
    fingers = dict.fromkeys(joint.split("_")[0] for joint in HAND_JOINTS if "_" in joint)
    return HandSkeleton(joints=list(HAND_JOINTS), edges=[(a, b) for a, b in HAND_EDGES], fingers=list(fingers))


@router.get("/hand-models")
def list_hand_models(session: SessionDep, cursor: Cursor = None, limit: Limit = 100) -> Page[HandModelOut]:
    """Hand models: first those that come with Handloom, then those that were trained or uploaded, the newest first."""
    rows, next_cursor = service.list_hand_models(session, cursor, limit)
    built_in = storing.list_built_in(session) if cursor is None else []
    return Page(items=[*built_in, *service.describe_hand_models(session, rows)], next_cursor=next_cursor)


@router.get("/hand-models/{model_id}", responses=error_responses(404))
def get_hand_model(model_id: uuid.UUID, session: SessionDep) -> HandModelOut:
    """One hand model."""
    for model in storing.list_built_in(session):
        if model.id == model_id:
            return model
    return service.describe_hand_models(session, [service.get_hand_model(session, model_id)])[0]


@router.get("/hand-models/{model_id}/report", responses=error_responses(404))
def get_hand_model_report(model_id: uuid.UUID, session: SessionDep) -> HandModelReport:
    """What training found: errors, spaces of shape and pose, times."""
    row = service.get_hand_model(session, model_id)
    if row.report is None:
        raise NotFoundError(f"{row.name} was not trained here, so there is no report of its training.")
    return HandModelReport(report=row.report)


@router.delete("/hand-models/{model_id}", status_code=204, responses=error_responses(404))
def delete_hand_model(model_id: uuid.UUID, session: SessionDep, lead: LeadAccount) -> None:
    """Hide a hand model. Nothing of it is lost: `restore` brings it back."""
    service.delete_hand_model(session, service.get_hand_model(session, model_id))
    record_act(session, lead.id, "hand_model.delete", "hand_model", model_id)


@router.post("/hand-models/{model_id}/restore", responses=error_responses(404))
def restore_hand_model(model_id: uuid.UUID, session: SessionDep, lead: LeadAccount) -> HandModelOut:
    """Undo a deletion."""
    row = service.get_hand_model(session, model_id, deleted_too=True)
    service.restore_hand_model(session, row)
    record_act(session, lead.id, "hand_model.restore", "hand_model", model_id)
    return service.describe_hand_models(session, [row])[0]
