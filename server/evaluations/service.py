"""Compares tracks with annotations."""

from __future__ import annotations

import uuid
from typing import Any

from server.annotations.service import load_annotations
from server.database import Database
from server.storage import Storage
from server.tracks.models import TrackRow
from server.tracks.service import get_track


def evaluate(database: Database, storage: Storage, track_id: uuid.UUID) -> dict[str, Any]:
    """Evaluate a track against the annotations of its recording; its mean error is kept with its row."""
    from tracker import evaluate_track, load_track

    with database.reading() as session:
        row = get_track(session, track_id)
        annotations = load_annotations(session, row.sequence_id)
    result = evaluate_track(load_track(storage.folder("tracks", track_id)), annotations).to_json()
    error_px = result["joint_error_px"].get("mean") if result["evaluated"] else None
    if error_px != row.error_px:
        with database.writing() as session:
            track = session.get(TrackRow, track_id)
            assert track is not None
            track.error_px = error_px
    return result
