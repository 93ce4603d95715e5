"""`/sequences/{sequence_id}/triangulation`."""

from __future__ import annotations

import uuid

from fastapi import APIRouter

from server.compute import ComputeDep
from server.database import DatabaseDep
from server.errors import error_responses
from server.sequences.service import get_sequence
from server.suggestions.triangulation import triangulate_hand
from server.suggestions.triangulation_schemas import TriangulationIn, TriangulationOut

router = APIRouter(prefix="/sequences/{sequence_id}", tags=["suggestions"], responses=error_responses(404))


@router.post("/triangulation")
def triangulate(
    sequence_id: uuid.UUID, body: TriangulationIn, database: DatabaseDep, compute: ComputeDep
) -> TriangulationOut:
    """Joints in space from marks in several cameras, where every camera sees them, and how well the marks agree.

    Nothing is stored.
    """
    with database.reading() as session:
        sequence = get_sequence(session, sequence_id)
    return compute.ask(triangulate_hand, sequence.name, sequence.cameras, body.views)
