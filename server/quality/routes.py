"""`/sequences/{sequence_id}/flags`: labels that look wrong."""

from __future__ import annotations

import uuid
from typing import Annotated

from fastapi import APIRouter, Query, Response

from server.access.service import CurrentAccount
from server.annotations.routes import PlaceDep
from server.compute import ComputeDep
from server.database import SessionDep
from server.database.paging import Cursor, Limit
from server.errors import error_responses
from server.quality import service
from server.quality.finding import Kind
from server.quality.flag_page import FlagQuestion, make_flag_page
from server.quality.schemas import FlagLook, FlagPage
from server.quality.service import IN_TURN, HiddenDep

router = APIRouter(prefix="/sequences/{sequence_id}", tags=["quality"], responses=error_responses(404))


@router.get("/flags", response_model=FlagPage, dependencies=[IN_TURN])
async def list_flags(
    sequence_id: uuid.UUID,
    hidden: HiddenDep,
    compute: ComputeDep,
    kind: Annotated[Kind | None, Query(description="Only these.")] = None,
    dismissed: Annotated[bool, Query(description="Those that were put away instead of the open ones.")] = False,
    cursor: Cursor = None,
    limit: Limit = 100,
) -> Response:
    """Labels that look wrong as they are now, the worst first, and what the checks could look at."""
    asked = FlagQuestion(sequence_id, hidden, kind, dismissed, cursor, limit)
    return Response(await compute.run(make_flag_page, asked), media_type="application/json")


@router.put("/flags/{camera}/{frame}/{hand}/{kind}/dismissal", status_code=204, responses=error_responses(409))
def dismiss_flag(place: PlaceDep, kind: Kind, body: FlagLook, session: SessionDep, account: CurrentAccount) -> None:
    """The label is right: dismiss the flag for this revision of it. 409 when the label has changed meanwhile."""
    service.dismiss(session, place, kind, body.revision, account.id)


@router.delete("/flags/{camera}/{frame}/{hand}/{kind}/dismissal", status_code=204)
def restore_flag(
    place: PlaceDep, kind: Kind, session: SessionDep, revision: Annotated[int, Query(ge=1, le=10**9)]
) -> None:
    """Restore a dismissed flag."""
    service.restore(session, place, kind, revision)
