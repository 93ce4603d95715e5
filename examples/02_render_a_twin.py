"""Render a hand whose pose is known, track it and compare: `python examples/02_render_a_twin.py`."""

import tempfile
from pathlib import Path

from tracker import TrackOptions, join_chunks, load_annotations, start_tracking, track_frames
from tracker.capture.truth import load_truth
from tracker.evaluation import evaluate_against_truth
from tracker.model import save_model
from tracker.model.default_hand import default_hand
from tracker.synthesis.motion import perform
from tracker.synthesis.recording import RecordingOptions, write_recording

hand = default_hand("right")
performance = perform({"right": hand}, "open-close", num_moments=60)

with tempfile.TemporaryDirectory() as folder:
    recording = Path(folder) / "open-close"
    sequence = write_recording(performance, recording, RecordingOptions(range(60), seed=1), save_model)

    options = TrackOptions(calibrate=False)  # the hand is known
    annotations = load_annotations(recording / "annotations.json")
    setup, state = start_tracking(sequence, options, {"right": hand}, annotations)
    _, chunk = track_frames(sequence, setup, state, options.frame_range(sequence.frame_count))

    error = evaluate_against_truth(join_chunks(sequence, setup, [chunk]), load_truth(recording / "truth.npz"))
    print(f"joints are {error.statistics_mm.mean:.2f} mm off on average, {error.statistics_mm.max:.2f} mm at worst")
    print(f"lost frames: {int(error.is_lost.sum())}")
