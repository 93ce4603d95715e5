"""How far the work on assignments is."""

from __future__ import annotations

import uuid
from collections.abc import Sequence
from dataclasses import dataclass

from sqlalchemy import and_, select
from sqlalchemy.orm import Session

from server.access.project_models import AssignmentRow, ReplicaSetRow
from server.annotations.models import AnnotationRow
from server.annotations.service import is_frame_done, measure_frame
from server.annotations.sources import JOINT_COUNT
from server.sequences.models import SequenceRow


@dataclass(frozen=True)
class Progress:
    """Frames of an assignment.

    Attributes:
        frames: How many.
        done: Those in which every joint that is asked for is decided: placed, or said to be not in the image.
        partial: Those that were begun and are not done.
        next_frame: The first that is not done.
    """

    frames: int
    done: int
    partial: int
    next_frame: int | None


def find_progress(
    session: Session, rows: Sequence[AssignmentRow], sets: dict[uuid.UUID, ReplicaSetRow]
) -> dict[uuid.UUID, Progress]:
    """Progress of some assignments by their ids.

    Of a range each hand of the recording is asked for in one camera at least, and nothing begun may stay half done; of
    a replica set every hand in every camera.
    """
    is_done: dict[uuid.UUID, dict[int, bool]] = {row.id: {} for row in rows}
    asked = _count_hands(session, rows)
    ranges = [row.id for row in rows if row.replica_set_id is None]
    query = (
        select(AssignmentRow.id, AnnotationRow.frame, *measure_frame())
        .join(
            AnnotationRow,
            and_(
                AnnotationRow.sequence_id == AssignmentRow.sequence_id,
                AnnotationRow.replica == "",
                AnnotationRow.frame.between(AssignmentRow.frame_first, AssignmentRow.frame_last),
                AnnotationRow.decided > 0,
            ),
        )
        .where(AssignmentRow.id.in_(ranges))
        .group_by(AssignmentRow.id, AnnotationRow.frame)
    )
    for id_, frame, hands, least in session.execute(query) if ranges else ():
        is_done[id_][frame] = is_frame_done(hands, least, asked[id_])
    replicas = {str(row.id): row for row in rows if row.replica_set_id is not None}
    query = select(AnnotationRow.replica, AnnotationRow.frame, AnnotationRow.decided).where(
        AnnotationRow.sequence_id.in_({row.sequence_id for row in rows}),
        AnnotationRow.replica.in_(replicas),
        AnnotationRow.decided > 0,
    )
    whole: dict[tuple[uuid.UUID, int], int] = {}
    for replica, frame, decided in session.execute(query) if replicas else ():
        row = replicas[replica]
        replica_set = sets[row.replica_set_id] if row.replica_set_id else None
        key = (row.id, frame)
        whole[key] = whole.get(key, 0) + (decided == JOINT_COUNT)
        needed = len(replica_set.cameras) * len(replica_set.hands) if replica_set else 1
        is_done[row.id][frame] = whole[key] >= needed
    return {row.id: _measure(row, sets.get(row.replica_set_id or row.id), is_done[row.id]) for row in rows}


def _count_hands(session: Session, rows: Sequence[AssignmentRow]) -> dict[uuid.UUID, int]:
    """Hands that a frame is asked for, by assignment."""
    ids = {row.sequence_id for row in rows}
    found = session.execute(select(SequenceRow.id, SequenceRow.hands).where(SequenceRow.id.in_(ids)))
    hands = {id_: len(names) or 1 for id_, names in found}
    return {row.id: hands[row.sequence_id] for row in rows}


def _measure(row: AssignmentRow, replicas: ReplicaSetRow | None, is_done: dict[int, bool]) -> Progress:
    """Goes through the frames that were begun, and through others only up to the first that is missing."""
    wanted = range(row.frame_first, row.frame_last + 1) if replicas is None else sorted(replicas.frames)
    begun = [done for frame, done in is_done.items() if replicas is None or frame in replicas.frames]
    next_frame = next((frame for frame in wanted if not is_done.get(frame, False)), None)
    return Progress(len(wanted), sum(begun), len(begun) - sum(begun), next_frame)
