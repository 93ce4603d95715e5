"""Which track of a recording stands for it."""

from __future__ import annotations

from server.tracks.best_tracks import find_best_tracks
from server.tracks.models import TrackRow
from tests.server.conftest import Studio, Tracked


def test_a_few_frames_that_fit_well_do_not_stand_for_a_recording_that_another_track_follows(
    studio: Studio, tracked: Tracked
) -> None:
    with studio.database.writing() as session:
        whole = session.get_one(TrackRow, tracked.track_id)
        whole.error_px = 3.0
        for name, frames, lost, error in (("short", 4, 0, 0.1), ("lost", 12, 1, 0.1), ("farther", 12, 0, 3.5)):
            facts = {"name": name, "frame_first": 0, "frame_count": frames, "hands": ["right"], "error_px": error}
            summary = whole.summary | {"lost": lost}
            session.add(TrackRow(sequence_id=tracked.sequence_id, job_id=None, summary=summary, **facts))
        session.flush()
        best = find_best_tracks(session, [tracked.sequence_id])[tracked.sequence_id]
        assert best["best_track"]["id"] == tracked.track_id
