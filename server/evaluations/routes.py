"""`/tracks/{id}/evaluation`."""

from __future__ import annotations

import uuid
from typing import Any

from fastapi import APIRouter

from server.database import DatabaseDep
from server.errors import error_responses
from server.evaluations import service
from server.storage import StorageDep

router = APIRouter(tags=["evaluations"], responses=error_responses())


@router.get("/tracks/{track_id}/evaluation", responses=error_responses(404))
def get_track_evaluation(track_id: uuid.UUID, database: DatabaseDep, storage: StorageDep) -> dict[str, Any]:
    """Errors of a track against the annotations as they are now, px, for each joint and frame."""
    return service.evaluate(database, storage, track_id)
