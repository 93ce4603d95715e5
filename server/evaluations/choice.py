"""Which tracks a question is about."""

from __future__ import annotations

import json
import uuid
from dataclasses import dataclass

from sqlalchemy import select
from sqlalchemy.orm import Session

from server.access.project_models import ProjectRow, ProjectSequenceRow
from server.errors import InvalidError, NotFoundError
from server.evaluations.labels import LabelsId, find_current_labels, find_snapshots
from server.evaluations.schemas import MAX_TRACKS, EvaluationQuery
from server.jobs.models import JobRow
from server.sequences.models import SequenceRow
from server.sequences.service import get_sequence
from server.tracks.models import TrackRow
from server.tracks.service import get_track


@dataclass(frozen=True)
class Chosen:
    """A track, its recording, and the labels that are to judge it."""

    track: TrackRow
    sequence: SequenceRow
    labels: LabelsId


def choose_tracks(session: Session, query: EvaluationQuery) -> list[Chosen]:
    """The tracks in the order asked for, each once."""
    rows = [get_track(session, track_id) for track_id in query.track]
    for sequence_id in query.sequence:
        get_sequence(session, sequence_id)
        rows += _find_tracks(session, [sequence_id])
    if query.project is not None:
        rows += _find_project_tracks(session, query.project)
    tracks = list({row.id: row for row in rows}.values())
    if len(tracks) > MAX_TRACKS:
        raise InvalidError(f"These are {len(tracks)} tracks; at most {MAX_TRACKS} can be compared. Name fewer.")
    if query.reference is not None and query.reference not in {row.id for row in tracks}:
        raise NotFoundError(f"The reference {query.reference} is none of the {len(tracks)} tracks that are compared.")
    snapshots = find_snapshots(session, query.snapshot)
    sequences: dict[uuid.UUID, SequenceRow] = {}
    labels: dict[uuid.UUID, LabelsId] = {}
    for track in tracks:
        key = track.sequence_id
        if key not in sequences:
            sequences[key] = get_sequence(session, key, deleted_too=True)
            labels[key] = snapshots.get(key) or find_current_labels(session, key)
    return [Chosen(track, sequences[track.sequence_id], labels[track.sequence_id]) for track in tracks]


def _find_tracks(session: Session, sequence_ids: list[uuid.UUID]) -> list[TrackRow]:
    query = select(TrackRow).where(TrackRow.sequence_id.in_(sequence_ids), TrackRow.deleted_at.is_(None))
    return list(session.scalars(query.order_by(TrackRow.created_at.desc(), TrackRow.id)).all())


def _find_project_tracks(session: Session, project_id: uuid.UUID) -> list[TrackRow]:
    """Of each recording the newest track of every set of parameters."""
    if session.get(ProjectRow, project_id) is None:
        raise NotFoundError(f"There is no project {project_id}.")
    places = (
        select(ProjectSequenceRow.sequence_id)
        .join(SequenceRow, SequenceRow.id == ProjectSequenceRow.sequence_id)
        .where(ProjectSequenceRow.project_id == project_id, SequenceRow.deleted_at.is_(None))
        .order_by(ProjectSequenceRow.added_at, ProjectSequenceRow.id)
    )
    order = list(session.scalars(places).all())
    tracks = _find_tracks(session, order)
    jobs = {track.job_id for track in tracks if track.job_id is not None}
    found = session.execute(select(JobRow.id, JobRow.params).where(JobRow.id.in_(jobs))) if jobs else []
    params = {id_: json.dumps(values, sort_keys=True) for id_, values in found}
    newest: dict[tuple[uuid.UUID, str | None], TrackRow] = {}
    for track in tracks:
        newest.setdefault((track.sequence_id, params.get(track.job_id) if track.job_id else None), track)
    return sorted(newest.values(), key=lambda track: order.index(track.sequence_id))
