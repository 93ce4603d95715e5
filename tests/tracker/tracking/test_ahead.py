"""The next frame is prepared in a second thread, and nothing but the time tells."""

from __future__ import annotations

import threading
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from tracker.errors import FrameError
from tracker.fitting.options import TrackOptions
from tracker.tracking.ahead import Glance, read_ahead
from tracker.tracking.follow import track_frames
from tracker.tracking.start import start_tracking

TWO = TrackOptions(calibrate=False, threads=2)
BEFORE: dict = {}


@pytest.fixture(scope="module")
def begun(recorded):
    """Setup with two threads, and the state before the first frame."""
    return start_tracking(recorded.sequence, TWO, annotations=recorded.annotations)


def test_two_threads_give_the_bits_of_one(recorded, run, begun):
    setup, state = begun
    chunk = track_frames(recorded.sequence, setup, state, range(12))[1]
    np.testing.assert_array_equal(chunk.pose, run[3].pose)
    assert list(chunk.status) == list(run[3].status)


class Watched:
    """A recording that tells which frames were read in which thread, and whose frames from one on are broken."""

    def __init__(self, sequence: Any, broken: int = 1000) -> None:
        self._sequence, self._broken = sequence, broken
        self.read: list[tuple[int, bool]] = []

    def __getattr__(self, name: str) -> Any:
        return getattr(self._sequence, name)

    def frame(self, index, camera_id):
        self.read.append((index, threading.current_thread() is threading.main_thread()))
        if index >= self._broken:
            raise FrameError(f"frame {index} is broken")
        return self._sequence.frame(index, camera_id)


def test_each_frame_is_read_once_and_none_beyond_the_last_that_was_asked_for(recorded, begun):
    setup, state = begun
    watched: Any = Watched(recorded.sequence)
    track_frames(watched, setup, state, range(4))
    assert watched.read == [(0, True), (1, False), (2, False), (3, False)]


def test_a_frame_that_cannot_be_read_stops_the_run_at_its_turn_and_not_before(recorded, begun):
    setup, state = begun
    watched: Any = Watched(recorded.sequence, broken=3)
    tracked: list[int] = []
    with pytest.raises(FrameError, match="frame 3 is broken"):
        track_frames(watched, setup, state, range(6), lambda index, _: tracked.append(index))
    assert tracked == [0, 1, 2]


def test_a_look_that_was_not_guessed_is_not_taken(recorded, begun):
    setup, _ = begun
    glance = Glance(5, BEFORE, (0, 1))
    with read_ahead(recorded.sequence, setup, 12) as ahead:
        assert ahead is not None
        ahead.begin(glance)
        assert ahead.take(glance).sightings is not None
        for other in (replace(glance, turns=(0, 2)), replace(glance, before={})):
            ahead.begin(glance)
            read = ahead.take(other)
            assert read.sightings is None
            assert read.frame.index == 5


def test_one_thread_prepares_nothing(recorded, run):
    with read_ahead(recorded.sequence, run[0], 12) as ahead:
        assert ahead is None
