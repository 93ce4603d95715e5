"""Tracks in the bin."""

from __future__ import annotations

from server.bin.kinds import make_kind
from server.tracks.models import TrackRow

TRACKS = make_kind("track", "track", TrackRow, "tracks", ("recording", TrackRow.sequence_id))
