"""A hand is calibrated from what is seen, and a lab's joints from the marks of the first frame."""

from dataclasses import replace

import numpy as np
import pytest

from tracker.capture.annotations import Annotations, load_annotations
from tracker.capture.truth import load_truth
from tracker.fitting.options import TrackOptions
from tracker.model.default_hand import default_hand
from tracker.model.hand_directions import HandDirections
from tracker.model.joints import HAND_JOINTS
from tracker.model.local_directions import local_directions
from tracker.model.npz_files import save_npz_model
from tracker.synthesis.motion import perform
from tracker.synthesis.recording import RecordingOptions, write_recording
from tracker.tracking.follow import track_frames
from tracker.tracking.start import start_tracking
from tracker.tracking.track import join_chunks

WRIST, MIDDLE = HAND_JOINTS.index("wrist"), HAND_JOINTS.index("middle_mcp")


@pytest.fixture(scope="module")
def elsewhere(recorded):
    """Where another lab, 10 mm up the forearm, sees the wrist: (T, 3) world, m."""
    wrist, middle = recorded.truth.joints_3d[:, WRIST], recorded.truth.joints_3d[:, MIDDLE]
    away = wrist - middle
    return wrist + 0.010 * away / np.linalg.norm(away, axis=1, keepdims=True)


def track_with(recorded, annotations):
    setup, start = start_tracking(recorded.sequence, TrackOptions(), annotations=annotations)
    _, chunk = track_frames(recorded.sequence, setup, start, range(12))
    return join_chunks(recorded.sequence, setup, [chunk])


@pytest.mark.slow
def test_the_wrist_is_where_the_first_frame_marks_it_in_every_frame(recorded, elsewhere):
    first = recorded.annotations.items[0]
    points = first.points.copy()
    points[WRIST, :2] = recorded.sequence.camera("cam0").project(elsewhere[:1])[0]
    track = track_with(recorded, Annotations((replace(first, points=points),)))
    off = np.linalg.norm(track.joints_3d[:, WRIST] - elsewhere, axis=1)
    assert off.max() < 5e-3  # m, of the 10 that it was
    others = [joint for joint in range(21) if joint != WRIST]
    error = np.linalg.norm(track.joints_3d[:, others] - recorded.truth.joints_3d[:, others], axis=2)
    assert error.mean() < 2e-3  # m


@pytest.mark.slow
def test_the_right_hand_is_left_nearly_as_it_is(recorded):
    track = track_with(recorded, recorded.annotations)
    assert recorded.joint_errors(track.frame, track.joints_3d).max() < 2.5e-3  # m


@pytest.mark.slow
def test_another_persons_hand_is_found_from_depth_and_marks(tmp_path):
    hand = default_hand("right")
    directions = HandDirections.join([HandDirections.of_shape(hand), local_directions(hand)])
    values = np.random.default_rng(5).normal(scale=0.7, size=len(directions.names))
    values[0] = 2.0
    person = directions.apply(hand, values)
    performance = perform({"right": person}, "open-close", 60)
    sequence = write_recording(performance, tmp_path / "hand", RecordingOptions(range(0, 40, 4)), save_npz_model)
    truth = load_truth(tmp_path / "hand" / "truth.npz")
    assert sequence.annotations_path is not None
    annotations = load_annotations(sequence.annotations_path)
    error = {}
    for calibrate in (False, True):
        setup, start = start_tracking(sequence, TrackOptions(calibrate=calibrate), annotations=annotations)
        _, chunk = track_frames(sequence, setup, start, range(10))
        track = join_chunks(sequence, setup, [chunk])
        error[calibrate] = np.linalg.norm(track.joints_3d - truth.joints_3d, axis=2).mean()
    assert error[True] < min(2e-3, 0.3 * error[False])  # m
