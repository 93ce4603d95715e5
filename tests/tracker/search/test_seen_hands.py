"""When the detector's joints have a say: not where the depth image settles the hand."""

from __future__ import annotations

import numpy as np

from tracker.capture.truth import load_truth
from tracker.fitting.options import TrackOptions
from tracker.model.default_hand import default_hand
from tracker.model.npz_files import save_npz_model
from tracker.synthesis.motion import perform
from tracker.synthesis.recording import RecordingOptions, write_recording
from tracker.tracking.follow import track_frames
from tracker.tracking.start import start_tracking

CLOSING = range(13, 24)
"""Frames in which the fingers close; the detector, made for photographs, puts a drawn fist's joints 3 cm off."""


def test_a_drawn_fist_that_the_depth_settles_is_not_pulled_to_wrong_joints(tmp_path):
    performance = perform({"right": default_hand("right")}, "open-close", 60)
    sequence = write_recording(performance, tmp_path / "fist", RecordingOptions(CLOSING), save_npz_model)
    setup, start = start_tracking(sequence, TrackOptions(calibrate=False))
    qualities = []
    _, chunk = track_frames(
        sequence, setup, start, range(len(CLOSING)), on_frame=lambda _, frame: qualities.append(frame.quality)
    )
    camera = sequence.cameras[0]
    found = np.stack([camera.project(setup.scene.pose_at(pose).landmarks(0)) for pose in chunk.pose])
    distances = np.linalg.norm(found - load_truth(tmp_path / "fist" / "truth.npz").joints_2d[:, 0], axis=-1)
    assert max(quality.apart for quality in qualities) > 0.4  # the detector does say something else
    assert distances.max() < 6.0  # px
