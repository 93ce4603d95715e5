"""What tracks say about their recordings."""

from __future__ import annotations

import uuid
from collections.abc import Sequence
from typing import Any

from sqlalchemy import select
from sqlalchemy.orm import Session

from server.tracks.models import TrackRow


def find_best_tracks(session: Session, sequence_ids: Sequence[uuid.UUID]) -> dict[uuid.UUID, dict[str, Any]]:
    """For each recording with tracks its `best_track`: the one closest to the annotations, else to the depth.

    A track that holds the hands in more frames comes before one that holds them in fewer, however near that one is.
    """
    query = select(TrackRow).where(TrackRow.sequence_id.in_(sequence_ids), TrackRow.deleted_at.is_(None))
    best: dict[uuid.UUID, TrackRow] = {}
    for track in session.scalars(query.order_by(TrackRow.created_at.desc(), TrackRow.id)):
        known = best.get(track.sequence_id)
        if known is None or _badness(track) < _badness(known):
            best[track.sequence_id] = track
    return {
        id_: {"best_track": {"id": track.id, "summary": track.summary, "error_px": track.error_px}}
        for id_, track in best.items()
    }


def _badness(track: TrackRow) -> tuple[int, float, float]:
    lost = track.summary.get("lost") or 0
    residual = track.summary.get("depth_residual_mm")
    return (
        int(lost) - track.frame_count,
        float("inf") if track.error_px is None else track.error_px,
        float("inf") if residual is None else float(residual),
    )
