"""The floor of a frame has the stages of the track and is never much above what the track took."""

from __future__ import annotations

import pytest

from tracker.cli.floor import measure_floor
from tracker.tracking.track import join_chunks


@pytest.fixture(scope="module")
def tracked(recorded, run):
    setup, _, _, chunk = run
    return recorded.sequence, join_chunks(recorded.sequence, setup, [chunk])


def test_every_stage_is_one_of_the_tracks_own_and_takes_some_time(tracked) -> None:
    sequence, track = tracked
    floor = measure_floor(sequence, track, num_frames=1)
    assert {"observing", "posing", "rendering", "solving"} <= floor.keys() <= set(track.summary()["stages_ms"])
    assert all(0 < ms < 1000 for ms in floor.values())
