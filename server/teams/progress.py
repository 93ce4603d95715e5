"""How far the work on assignments is."""

from __future__ import annotations

import uuid
from collections.abc import Sequence
from dataclasses import dataclass

from sqlalchemy import and_, null, select
from sqlalchemy.orm import Session

from server.annotations.models import AnnotationRow
from server.teams.models import AssignmentRow, ReplicaSetRow


@dataclass(frozen=True)
class Progress:
    """Frames of an assignment: how many, how many of them are done, the first that is not."""

    frames: int
    done: int
    next_frame: int | None


def find_progress(
    session: Session, rows: Sequence[AssignmentRow], sets: dict[uuid.UUID, ReplicaSetRow]
) -> dict[uuid.UUID, Progress]:
    """Progress of some assignments by their ids. A frame of a range is done when somebody marked a hand in it, one of a
    replica set when every hand is marked in every camera."""
    ranges = [row.id for row in rows if row.replica_set_id is None]
    marked: dict[uuid.UUID, dict[int, int]] = {row.id: {} for row in rows}
    query = (
        select(AssignmentRow.id, AnnotationRow.frame)
        .join(
            AnnotationRow,
            and_(
                AnnotationRow.sequence_id == AssignmentRow.sequence_id,
                AnnotationRow.replica == "",
                AnnotationRow.frame.between(AssignmentRow.frame_first, AssignmentRow.frame_last),
                AnnotationRow.points.is_not(null()),
            ),
        )
        .where(AssignmentRow.id.in_(ranges))
        .distinct()
    )
    for id_, frame in session.execute(query) if ranges else ():
        marked[id_][frame] = 1
    replicas = {str(row.id): row.id for row in rows if row.replica_set_id is not None}
    query = select(AnnotationRow.replica, AnnotationRow.frame).where(
        AnnotationRow.sequence_id.in_({row.sequence_id for row in rows}),
        AnnotationRow.replica.in_(replicas),
        AnnotationRow.points.is_not(null()),
    )
    for replica, frame in session.execute(query) if replicas else ():
        frames = marked[replicas[replica]]
        frames[frame] = frames.get(frame, 0) + 1
    return {
        row.id: _measure(row, sets.get(row.replica_set_id) if row.replica_set_id else None, marked[row.id])
        for row in rows
    }


def _measure(row: AssignmentRow, replicas: ReplicaSetRow | None, marked: dict[int, int]) -> Progress:
    wanted = range(row.frame_first, row.frame_last + 1) if replicas is None else sorted(replicas.frames)
    needed = 1 if replicas is None else len(replicas.cameras) * len(replicas.hands)
    missing = [frame for frame in wanted if marked.get(frame, 0) < needed]
    return Progress(len(wanted), len(wanted) - len(missing), missing[0] if missing else None)
