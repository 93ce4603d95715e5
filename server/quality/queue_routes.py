"""`/sequences/{sequence_id}/frames-to-look-at`: the hands that most need a person, labelled or not."""

from __future__ import annotations

import uuid

from fastapi import APIRouter, Response

from server.compute import ComputeDep
from server.database.paging import Cursor, Limit
from server.errors import error_responses
from server.quality.queue_page import QueueQuestion, make_queue_page
from server.quality.queue_schemas import QueuePage
from server.quality.service import IN_TURN, HiddenDep

router = APIRouter(prefix="/sequences/{sequence_id}", tags=["quality"], responses=error_responses(404))


@router.get("/frames-to-look-at", response_model=QueuePage, dependencies=[IN_TURN])
async def list_frames_to_look_at(
    sequence_id: uuid.UUID, hidden: HiddenDep, compute: ComputeDep, cursor: Cursor = None, limit: Limit = 100
) -> Response:
    """Every hand that a track, the hand detector or a label speaks of, the one that most needs a person first."""
    asked = QueueQuestion(sequence_id, hidden, cursor, limit)
    return Response(await compute.run(make_queue_page, asked), media_type="application/json")
