"""The swarm as a tracker, on a drawn tube and on a short rendered recording of a hand."""

from __future__ import annotations

from dataclasses import fields, replace

import numpy as np
import pytest

from benchmarks.baselines import SwarmOptions, track_with_swarm
from benchmarks.baselines.swarm_tracker import thin_to
from tests.tracker.scenes import drawn_tube
from tracker.capture.annotations import load_annotations
from tracker.capture.truth import load_truth
from tracker.evaluation import evaluate_against_truth
from tracker.fitting.options import TrackOptions
from tracker.model.default_hand import default_hand
from tracker.model.npz_files import save_npz_model
from tracker.synthesis.motion import perform
from tracker.synthesis.recording import RecordingOptions, write_recording
from tracker.tracking.chunk import TrackChunk
from tracker.tracking.start import start_tracking
from tracker.tracking.track import join_chunks

SMALL = SwarmOptions(particles=16, generations=10)


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory):
    """Three frames of the default right hand opening and closing, its truth and its start."""
    folder = tmp_path_factory.mktemp("swarm") / "hand"
    performance = perform({"right": default_hand("right")}, "open-close", 60)
    sequence = write_recording(performance, folder, RecordingOptions(range(3)), save_npz_model)
    annotations = load_annotations(folder / "annotations.json")
    setup, state = start_tracking(sequence, TrackOptions(calibrate=False), annotations=annotations)
    return sequence, load_truth(folder / "truth.npz"), setup, state.pose


def without_times(chunk: TrackChunk) -> dict[str, np.ndarray]:
    return {f.name: getattr(chunk, f.name) for f in fields(chunk) if f.name not in ("seconds", "stages")}


def test_a_displaced_hand_is_found_better_than_it_started(recorded, rng):
    sequence, truth, setup, pose = recorded
    step = rng.normal(scale=0.15, size=pose.shape)
    step[:3] = rng.normal(scale=0.01, size=3)
    start = setup.scene.retract(pose, step)
    chunk = track_with_swarm(sequence, setup, start, range(1), SwarmOptions(particles=48, generations=30))
    found = evaluate_against_truth(join_chunks(sequence, setup, [chunk]), truth).error.mean()
    before = np.linalg.norm(setup.scene.pose_at(start).landmarks(0) - truth.joints_3d[0], axis=-1).mean()
    assert found < 0.6 * before
    assert np.all(chunk.pose >= setup.scene.lower) and np.all(chunk.pose <= setup.scene.upper)


def test_the_same_seed_gives_the_same_bits_in_one_piece_and_in_chunks(recorded, rng):
    sequence, _, setup, pose = recorded
    start = setup.scene.retract(pose, rng.normal(scale=0.03, size=pose.shape))
    whole = track_with_swarm(sequence, setup, start, range(3), SMALL)
    assert not np.array_equal(whole.pose[0], start)
    first = track_with_swarm(sequence, setup, start, range(1), SMALL)
    rest = track_with_swarm(sequence, setup, first.pose[-1], range(1, 3), SMALL)
    pieces = TrackChunk.join([first, rest])
    for name, column in without_times(whole).items():
        assert np.array_equal(column, getattr(pieces, name), equal_nan=column.dtype.kind == "f"), name
    other = track_with_swarm(sequence, setup, start, range(1), replace(SMALL, seed=1))
    assert not np.array_equal(other.pose, first.pose)


def test_a_time_limit_ends_a_frame_early(recorded):
    sequence, _, setup, pose = recorded
    limited = SwarmOptions(generations=100_000, seconds_per_frame=0.3)
    chunk = track_with_swarm(sequence, setup, pose, range(1), limited)
    assert chunk.iterations[0] < 100_000
    assert 0.3 <= chunk.seconds[0] < 3.0


def test_a_hand_out_of_sight_is_lost_and_stays_where_it_was(recorded):
    sequence, _, setup, pose = recorded
    away = pose.copy()
    away[0] += 5.0
    chunk = track_with_swarm(sequence, setup, away, range(2), SMALL)
    assert list(join_chunks(sequence, setup, [chunk]).status) == ["lost", "lost"]
    assert np.array_equal(chunk.pose, np.stack([away, away]))


def test_poses_are_compared_in_few_pixels():
    seen = drawn_tube().observation
    assert 32 < max(thin_to(seen, 64).labels.shape) <= 64
