"""The next frame is prepared in a second thread, and nothing but the time tells."""

from __future__ import annotations

import threading
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from tracker.errors import FrameError
from tracker.fitting.options import TrackOptions
from tracker.model.default_hand import default_hand
from tracker.model.npz_files import save_npz_model
from tracker.synthesis.motion import perform
from tracker.synthesis.recording import RecordingOptions, write_recording
from tracker.tracking.ahead import FramesAhead, Glance, read_ahead
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
        assert isinstance(ahead, FramesAhead)
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


class WatchedViews(Watched):
    """The same of a recording of several cameras without depth."""

    def color(self, index, camera_id):
        self.read.append((index, threading.current_thread() is threading.main_thread()))
        if index >= self._broken:
            raise FrameError(f"frame {index} is broken")
        return self._sequence.color(index, camera_id)


@pytest.fixture(scope="module")
def views(tmp_path_factory):
    """A drawn hand before two cameras, tracked with colour alone."""
    performance = perform({"right": default_hand("right")}, "open-close", 60, 2, (320, 240))
    folder = tmp_path_factory.mktemp("ahead") / "views"
    return write_recording(performance, folder, RecordingOptions(range(5)), save_npz_model)


def follow_with(views, threads):
    options = TrackOptions(calibrate=False, cameras="cam0,cam1", use_depth=False, threads=threads)
    watched: Any = WatchedViews(views)
    setup, state = start_tracking(watched, options)
    watched.read.clear()
    return track_frames(watched, setup, state, range(5))[1], watched.read


def test_several_views_with_two_threads_give_the_bits_of_one_and_are_read_ahead(views):
    (one, _), (two, read) = (follow_with(views, threads) for threads in (1, 2))
    np.testing.assert_array_equal(two.pose, one.pose)
    np.testing.assert_array_equal(two.seen, one.seen)
    assert list(two.status) == list(one.status)
    assert sorted(index for index, _ in read) == [0, 0, 1, 1, 2, 2, 3, 3, 4, 4]
    assert not any(is_main for index, is_main in read if index > 0)


def test_a_moment_of_several_views_that_cannot_be_read_stops_the_run_at_its_turn(views):
    options = TrackOptions(calibrate=False, cameras="cam0,cam1", use_depth=False, threads=2)
    setup, state = start_tracking(views, options)
    watched: Any = WatchedViews(views, broken=2)
    tracked: list[int] = []
    with pytest.raises(FrameError, match="frame 2 is broken"):
        track_frames(watched, setup, state, range(5), lambda index, _: tracked.append(index))
    assert tracked == [0, 1]
