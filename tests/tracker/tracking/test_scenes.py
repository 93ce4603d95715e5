"""Two hands in one scene, and a hand with an object that somebody placed."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from tracker.capture.annotations import load_annotations
from tracker.capture.frame import Frame
from tracker.capture.recorded_object import RecordedObject
from tracker.capture.truth import load_truth
from tracker.fitting.options import TrackOptions
from tracker.geometry import se3
from tracker.model.default_hand import default_hand
from tracker.model.npz_files import save_npz_model
from tracker.model.scene import Scene
from tracker.search.leave_out import leave_out
from tracker.search.start_object import place_object
from tracker.synthesis.motion import perform
from tracker.synthesis.recording import RecordingOptions, write_recording
from tracker.tracking.follow import track_frames
from tracker.tracking.start import start_tracking
from tracker.tracking.track import join_chunks


@pytest.fixture(scope="module")
def two_hands(tmp_path_factory):
    folder = tmp_path_factory.mktemp("two") / "hands"
    performance = perform({side: default_hand(side) for side in ("right", "left")}, "wave", 60)
    sequence = write_recording(performance, folder, RecordingOptions(range(5)), save_npz_model)
    return sequence, load_truth(folder / "truth.npz")


def test_two_hands_are_tracked_as_one_scene(two_hands):
    sequence, truth = two_hands
    annotations = load_annotations(sequence.annotations_path)
    options = TrackOptions(calibrate=False, terms="LO+SC")
    setup, state = start_tracking(sequence, options, annotations=annotations)
    assert setup.scene.num_dofs == 74
    _, chunk = track_frames(sequence, setup, state, range(5))
    track = join_chunks(sequence, setup, [chunk])
    order = [truth.joint_names.index(name) for name in track.joint_names]
    errors = np.linalg.norm(track.joints_3d - truth.joints_3d[:, order], axis=-1).reshape(5, 2, 21).mean(axis=2)
    assert errors.max() < 1.5e-3  # m
    assert set(track.status) == {"ok"}


@pytest.mark.slow
def test_two_hands_without_annotations_do_not_share_a_place(two_hands):
    sequence, truth = two_hands
    setup, state = start_tracking(sequence, TrackOptions(calibrate=False))
    posed = setup.scene.pose_at(state.pose)
    for place, name in enumerate(setup.names):
        wrist = truth.joints_3d[0, truth.joint_names.index(f"{name}/wrist")]
        assert np.linalg.norm(posed.landmarks(place)[0] - wrist) < 0.01  # m


def test_what_a_model_explains_is_left_out_and_the_rest_is_kept(two_hands):
    sequence, _ = two_hands
    annotations = load_annotations(sequence.annotations_path)
    setup, state = start_tracking(sequence, TrackOptions(calibrate=False), annotations=annotations)
    frame, camera = setup.read(sequence, 0)
    middle = camera.width // 2
    rest = leave_out(frame, camera, setup.scene, state.pose, [setup.names.index("right")])
    kept = [np.count_nonzero(rest.depth[:, side]) for side in (slice(0, middle), slice(middle, None))]
    seen = [np.count_nonzero(frame.depth[:, side]) for side in (slice(0, middle), slice(middle, None))]
    shares = sorted(k / s for k, s in zip(kept, seen, strict=True))
    assert shares[0] < 0.1
    assert shares[1] > 0.99
    assert isinstance(rest, Frame)


def test_a_mesh_keeps_its_coordinates_when_it_is_placed(tmp_path):
    from tracker.model.files import load_model

    trimesh.creation.icosphere(subdivisions=2, radius=0.03).export(tmp_path / "ball.ply")
    model = load_model(tmp_path / "ball.ply")
    T = se3.exp(np.array([0.1, 0.2, 0.5, 0.3, -0.2, 0.9]))
    placed = place_object(model, RecordedObject("ball", "ball.ply", T))
    np.testing.assert_allclose(Scene((model,)).pose_at(placed).T_world_model(0), T, atol=1e-12)
