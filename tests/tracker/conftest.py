"""A short rendered recording of a waving hand, with its truth, for the tests of tracking."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from tests.once import make_once
from tracker.capture.annotations import Annotations, load_annotations
from tracker.capture.sequence import Sequence, load_sequence
from tracker.capture.truth import Truth, load_truth
from tracker.fitting.options import TrackOptions
from tracker.model.default_hand import default_hand
from tracker.model.npz_files import save_npz_model
from tracker.synthesis.motion import perform
from tracker.synthesis.recording import RecordingOptions, write_recording
from tracker.tracking.follow import track_frames
from tracker.tracking.start import start_tracking

FRAMES = 12


@dataclass(frozen=True)
class Recorded:
    """A rendered recording and what is known of it."""

    sequence: Sequence
    annotations: Annotations
    truth: Truth

    def joint_errors(self, frames: np.ndarray, joints_3d: np.ndarray) -> np.ndarray:
        """(T,) mean distance of the joints from the truth, m."""
        return np.linalg.norm(joints_3d - self.truth.joints_3d[frames], axis=-1).mean(axis=1)


@pytest.fixture(scope="session")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Recorded:
    """Twelve frames of the default right hand opening and closing, with a sensor's noise."""
    folder = make_once(tmp_path_factory, "recorded", _record) / "hand"
    sequence = load_sequence(folder)
    assert sequence.annotations_path is not None
    return Recorded(sequence, load_annotations(sequence.annotations_path), load_truth(folder / "truth.npz"))


def _record(folder: Path) -> None:
    performance = perform({"right": default_hand("right")}, "open-close", 60)
    write_recording(performance, folder / "hand", RecordingOptions(range(FRAMES)), save_npz_model)


@pytest.fixture(scope="session")
def run(recorded):
    """The recording tracked from its first annotation with the hand it was drawn with."""
    setup, start = start_tracking(recorded.sequence, TrackOptions(calibrate=False), annotations=recorded.annotations)
    end, chunk = track_frames(recorded.sequence, setup, start, range(12))
    return setup, start, end, chunk
