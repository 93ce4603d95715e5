"""With which cameras a track was made, and whether its recording has others by now."""

from __future__ import annotations

import hashlib
import json
import uuid
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from sqlalchemy import select
from sqlalchemy.orm import Session

from server.database import Base
from server.tracks.models import TrackRow
from server.tracks.schemas import TrackOut

PLACES = ("K", "distortion", "T_world_camera")
"""What says where a camera stands and how it sees."""


def digest_cameras(cameras: Iterable[dict[str, Any]]) -> str:
    """64 hexadecimal digits that change with the lens or the place of any camera, given as `sequence.json` has them."""
    places = [[np.asarray(camera[name], dtype=np.float64).tolist() for name in PLACES] for camera in cameras]
    return hashlib.sha256(json.dumps(places).encode()).hexdigest()


def find_digests(session: Session, sequence_ids: Iterable[uuid.UUID]) -> dict[uuid.UUID, str]:
    """The digest of the cameras that each recording has now."""
    recordings = Base.metadata.tables["sequences"]  # a table of a room that this one does not see
    query = select(recordings.c.id, recordings.c.cameras).where(recordings.c.id.in_(set(sequence_ids)))
    return {id_: digest_cameras(cameras) for id_, cameras in session.execute(query)}


def describe_tracks(session: Session, rows: Sequence[TrackRow]) -> list[TrackOut]:
    """Tracks as the API gives them, each with whether the cameras of its recording have changed since."""
    now = find_digests(session, (row.sequence_id for row in rows))
    fields = TrackOut.model_fields.keys() - {"is_of_earlier_cameras"}
    return [
        TrackOut.model_validate(
            {name: getattr(row, name) for name in fields}
            | {"is_of_earlier_cameras": row.cameras_digest not in (None, now[row.sequence_id])}
        )
        for row in rows
    ]
