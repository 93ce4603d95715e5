"""The track that an address names, for those who may look into it."""

from __future__ import annotations

import uuid
from typing import Annotated

from fastapi import Depends

from server.access.policy import check_sees_tracks
from server.access.service import CurrentAccount
from server.database import DatabaseDep
from server.tracks.models import TrackRow
from server.tracks.service import get_track


def get_seen_track(track_id: uuid.UUID, database: DatabaseDep, account: CurrentAccount) -> TrackRow:
    """The track of the address, if whoever asks may look into it."""
    with database.reading() as session:
        track = get_track(session, track_id)
        check_sees_tracks(session, account, track.sequence_id)
    return track


SeenTrack = Annotated[TrackRow, Depends(get_seen_track)]
