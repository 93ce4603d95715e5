"""Recordings, tracks and the last frames that suggestions were asked for, kept open: an annotator waits for nothing."""

from __future__ import annotations

import threading
import uuid
from collections import OrderedDict
from collections.abc import Callable, Hashable
from typing import TYPE_CHECKING, Any, TypeVar

from server.jobs.detections import AREA
from server.storage import Storage

if TYPE_CHECKING:
    from tracker import Frame, Sequence, Track
    from tracker.detection import RecordedHands

Thing = TypeVar("Thing")

KEPT = 8
"""Recordings, tracks, frames and what the hand detector found, together."""


class RecordingCache:
    """What was opened last."""

    def __init__(self, storage: Storage) -> None:
        self._storage = storage
        self._things: OrderedDict[Hashable, Any] = OrderedDict()
        self._lock = threading.Lock()

    def recording(self, sequence_id: uuid.UUID, content_key: str) -> Sequence:
        from tracker import load_sequence

        folder = self._storage.folder("sequences", sequence_id)
        return self._get((sequence_id, content_key), lambda: load_sequence(folder))

    def frame(self, sequence_id: uuid.UUID, content_key: str, camera: str, frame: int) -> Frame:
        recording = self.recording(sequence_id, content_key)
        return self._get((sequence_id, content_key, camera, frame), lambda: recording.frame(frame, camera))

    def track(self, track_id: uuid.UUID) -> tuple[Track, dict[int, int]]:
        """A track and the row of each of its frames."""
        return self._get(track_id, lambda: self._load_track(track_id))

    def detections(self, job_id: uuid.UUID) -> RecordedHands:
        """What a job of the hand detector found."""
        from tracker.detection import load_recorded_hands

        return self._get(("detections", job_id), lambda: load_recorded_hands(self._storage.document(AREA, job_id)))

    def _load_track(self, track_id: uuid.UUID) -> tuple[Track, dict[int, int]]:
        from tracker import load_track

        track = load_track(self._storage.folder("tracks", track_id))
        return track, {int(frame): row for row, frame in enumerate(track.frame)}

    def _get(self, key: Hashable, load: Callable[[], Thing]) -> Thing:
        with self._lock:
            if key in self._things:
                self._things.move_to_end(key)
                return self._things[key]
        loaded = load()
        with self._lock:
            self._things[key] = loaded
            while len(self._things) > KEPT:
                self._things.popitem(last=False)
        return loaded
