"""A small recording, a track of it whose joints are known, and labels beside them by a known distance."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from server.compute import ComputeContext
from server.database import Database
from server.sequences.models import SequenceRow
from server.storage import Storage
from server.tracks.models import TrackRow
from tests.server.conftest import MakeRecording
from tests.server.rows import keep, make_annotation, make_recording, make_track
from tracker import TrackOptions, load_sequence
from tracker.fitting.setup import TrackSetup
from tracker.model.default_hand import default_hand
from tracker.synthesis.motion import perform_motion
from tracker.tracking.chunk import TrackChunk
from tracker.tracking.frame_result import FrameResult
from tracker.tracking.track import join_chunks

FRAMES = 3


@dataclass
class Known:
    """A waving right hand in front of one camera.

    Attributes:
        joints: (3, 21, 2) px, where the track has them.
    """

    context: ComputeContext
    recording: SequenceRow
    track: TrackRow
    joints: np.ndarray

    @property
    def folder(self) -> Path:
        return self.context.storage.folder("tracks", self.track.id)

    def mark(self, frame: int, shift: tuple[float, float], **columns: Any) -> None:
        """Label a frame, each joint so many px beside the track."""
        points = [[float(x), float(y), 2] for x, y in self.joints[frame] + shift]
        keep(self.context.database, make_annotation(self.recording, frame, points, **columns))


def store_known(database: Database, folder: Path, make: MakeRecording, name: str = "waving") -> Known:
    """Nothing is labelled yet."""
    storage = Storage(folder)
    recording = make_recording(name, frame_count=FRAMES)
    track = make_track(recording, frame_count=FRAMES)
    keep(database, recording, track)
    make(name, frames=FRAMES).rename(storage.folder("sequences", recording.id))
    sequence = load_sequence(storage.folder("sequences", recording.id))
    hand = default_hand("right")
    setup = TrackSetup(("right",), (hand,), "cam0", TrackOptions())
    results = [
        FrameResult(frame, pose, "ok", 0.01, None, (), {})
        for frame, pose in enumerate(perform_motion(hand, "wave", FRAMES, 30.0))
    ]
    made = join_chunks(sequence, setup, [TrackChunk.of(results)])
    made.save(storage.folder("tracks", track.id))
    return Known(ComputeContext(database, storage), recording, track, np.array(made.joints_2d[:, 0, :21]))
