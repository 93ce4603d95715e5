"""A recording of a hand whose poses are known, and tracks of it that are off by known amounts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from tracker.capture.annotations import Annotations, load_annotations
from tracker.capture.sequence import Sequence
from tracker.capture.truth import Truth, load_truth
from tracker.fitting.options import TrackOptions
from tracker.fitting.setup import TrackSetup
from tracker.model import ArticulatedModel, save_model
from tracker.model.default_hand import default_hand
from tracker.synthesis.motion import perform, perform_motion
from tracker.synthesis.recording import RecordingOptions, write_recording
from tracker.tracking.chunk import TrackChunk
from tracker.tracking.frame_result import FrameResult
from tracker.tracking.track import Track, join_chunks

FRAMES = 5


@dataclass(frozen=True)
class Known:
    """A recording with all that is known of it."""

    sequence: Sequence
    model: ArticulatedModel
    poses: np.ndarray
    truth: Truth
    annotations: Annotations

    def track(
        self, change: Callable[[np.ndarray], None] = lambda poses: None, statuses: tuple[str, ...] = ("ok",) * FRAMES
    ) -> Track:
        """A track with the true poses, changed in place by `change`."""
        poses = self.poses.copy()
        change(poses)
        setup = TrackSetup(("right",), (self.model,), "cam0", TrackOptions())
        results = [
            FrameResult(frame, pose, status, 0.01, None, (), {})
            for frame, (pose, status) in enumerate(zip(poses, statuses, strict=True))
        ]
        return join_chunks(self.sequence, setup, [TrackChunk.of(results)])


@pytest.fixture(scope="session")
def known(tmp_path_factory) -> Known:
    folder: Path = tmp_path_factory.mktemp("known") / "wave"
    model = default_hand("right")
    performance = perform({"right": model}, "wave", FRAMES)
    sequence = write_recording(performance, folder, RecordingOptions(range(FRAMES)), save_model)
    poses = perform_motion(model, "wave", FRAMES, performance.fps)
    return Known(
        sequence, model, poses, load_truth(folder / "truth.npz"), load_annotations(folder / "annotations.json")
    )
