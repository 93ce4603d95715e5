"""Registrations of moving scans, and decisions about stretches of them."""

from __future__ import annotations

import uuid

from fastapi import APIRouter, Response

from server.access.audit import record_act
from server.access.service import ReviewerAccount
from server.database import SessionDep
from server.database.frames import FramePath
from server.database.paging import Page
from server.errors import error_responses
from server.moving_scans import decisions as decision_service
from server.moving_scans import registrations as service
from server.moving_scans.decision_schemas import (
    StretchDecisionMake,
    StretchDecisionOut,
    StretchDecisionUndo,
)
from server.moving_scans.models import StretchDecisionRow
from server.moving_scans.registration_schemas import FrameRegistrations, MovingRegistrationOut
from server.moving_scans.service import get_moving_scan
from server.moving_scans.storing import find_view
from server.scans.geometry import MEDIA_TYPE
from server.scans.routes import GEOMETRY, IMMUTABLE
from server.storage import StorageDep

router = APIRouter(tags=["moving scans"], responses=error_responses())


@router.get("/moving-scans/{moving_scan_id}/registrations", responses=error_responses(404))
def list_moving_registrations(moving_scan_id: uuid.UUID, session: SessionDep) -> Page[MovingRegistrationOut]:
    """Registrations of a moving scan, the newest first."""
    get_moving_scan(session, moving_scan_id, deleted_too=True)
    rows = service.list_registrations(session, moving_scan_id)
    return Page(items=service.describe_registrations(session, rows), next_cursor=None)


@router.get("/moving-registrations/{registration_id}", responses=error_responses(404))
def get_moving_registration(registration_id: uuid.UUID, session: SessionDep) -> MovingRegistrationOut:
    """One registration of a moving scan."""
    return service.describe_registrations(session, [service.get_registration(session, registration_id)])[0]


@router.get("/moving-registrations/{registration_id}/frames", responses=error_responses(404))
def list_registered_frames(registration_id: uuid.UUID, session: SessionDep) -> FrameRegistrations:
    """Every frame that is registered so far: verdict, distances, guessed hands, and what was decided."""
    row = service.get_registration(session, registration_id)
    return FrameRegistrations(frames=service.list_frames(session, row))


@router.get(
    "/moving-registrations/{registration_id}/frames/{frame}/geometry",
    response_class=Response,
    responses=GEOMETRY | error_responses(404),
)
def get_registered_geometry(
    registration_id: uuid.UUID, frame: FramePath, session: SessionDep, storage: StorageDep
) -> Response:
    """The surface of a frame with distances: `vertices`, `normals`, `vertex_error_mm`, `point_error_mm` of the
    points of the frame's own geometry, `guessed` (1 for vertices of a hand that the frame does not show)."""
    row = service.get_frame(session, registration_id, frame)
    data = find_view(storage, row.id).read_bytes()
    return Response(data, media_type=MEDIA_TYPE, headers={"Cache-Control": IMMUTABLE})


@router.get("/moving-scans/{moving_scan_id}/decisions", responses=error_responses(404))
def list_stretch_decisions(moving_scan_id: uuid.UUID, session: SessionDep) -> Page[StretchDecisionOut]:
    """Everything that was decided about a moving scan, the newest first."""
    get_moving_scan(session, moving_scan_id, deleted_too=True)
    rows = decision_service.list_decisions(session, moving_scan_id)
    return Page(items=decision_service.describe_decisions(session, rows)[::-1], next_cursor=None)


@router.post(
    "/moving-registrations/{registration_id}/decisions",
    status_code=201,
    responses={200: {"model": StretchDecisionOut}, **error_responses(404)},
)
def make_stretch_decision(
    registration_id: uuid.UUID,
    body: StretchDecisionMake,
    session: SessionDep,
    account: ReviewerAccount,
    response: Response,
) -> StretchDecisionOut:
    """Accept or reject frames of a registration. The same operation sent again is answered by 200 and what it made."""
    row = service.get_registration(session, registration_id)
    decision, is_new = decision_service.decide(session, row, account.id, body)
    return _answer(session, decision, is_new, response, account.id)


@router.post(
    "/stretch-decisions/{decision_id}/undo",
    status_code=201,
    responses={200: {"model": StretchDecisionOut}, **error_responses(404, 409)},
)
def undo_stretch_decision(
    decision_id: uuid.UUID, body: StretchDecisionUndo, session: SessionDep, account: ReviewerAccount, response: Response
) -> StretchDecisionOut:
    """Take a decision of one's own back; what was decided before it stands again. Both stay in the history."""
    decision, is_new = decision_service.undo(session, decision_id, account.id, body.operation_id)
    return _answer(session, decision, is_new, response, account.id)


def _answer(
    session: SessionDep, decision: StretchDecisionRow, is_new: bool, response: Response, account_id: uuid.UUID
) -> StretchDecisionOut:
    response.status_code = 201 if is_new else 200
    if is_new:
        record_act(session, account_id, f"stretch.{decision.decision}", "moving_registration", decision.registration_id)
    return decision_service.describe_decisions(session, [decision])[0]
