"""A drawn hand before three cameras without depth: found, followed, lost and found again."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import cv2
import numpy as np
import pytest

from tracker.capture.sequence import Sequence, load_sequence
from tracker.capture.truth import Truth, load_truth
from tracker.cli.__main__ import main
from tracker.errors import FrameError
from tracker.fitting.options import TrackOptions
from tracker.fitting.setup import TrackSetup, choose_cameras
from tracker.inspection.frame_view import describe_frame
from tracker.model.default_hand import default_hand
from tracker.model.npz_files import save_npz_model
from tracker.search.tools import make_tools
from tracker.synthesis.motion import perform
from tracker.synthesis.recording import RecordingOptions, write_recording
from tracker.tracking.chunk import TrackChunk
from tracker.tracking.follow import track_frames
from tracker.tracking.follow_views import follow_views
from tracker.tracking.start import start_tracking
from tracker.tracking.state import TrackState
from tracker.tracking.track import join_chunks, load_track

FRAMES, HIDDEN = 9, range(4, 6)
"""In two of the frames nothing is to be seen."""


@pytest.fixture(scope="module")
def views(tmp_path_factory: pytest.TempPathFactory) -> tuple[Sequence, Truth]:
    folder: Path = tmp_path_factory.mktemp("views") / "hand"
    performance = perform({"right": default_hand("right")}, "open-close", 60, 3, (480, 360))
    made = write_recording(performance, folder, RecordingOptions(range(FRAMES)), save_npz_model)
    for camera in made.cameras:
        for frame in HIDDEN:
            path = made.image_path("color", frame, camera.id)
            cv2.imwrite(str(path), np.zeros((360, 480, 3), dtype=np.uint8))
    description = json.loads((folder / "sequence.json").read_text())
    for camera in description["cameras"]:
        del camera["depth"], camera["depth_scale"]
    (folder / "sequence.json").write_text(json.dumps(description))
    return load_sequence(folder), load_truth(folder / "truth.npz")


@pytest.fixture(scope="module")
def run(views):
    setup, start = start_tracking(views[0], TrackOptions(calibrate=False))
    _, chunk = track_frames(views[0], setup, start, range(FRAMES))
    return setup, start, join_chunks(views[0], setup, [chunk])


def test_a_hand_is_found_followed_lost_where_no_view_shows_it_and_found_again(run):
    _, _, track = run
    assert track.status.tolist() == ["recovered", *["ok"] * 3, *["lost"] * 2, "recovered", *["ok"] * 2]
    assert track.hand_status[:, 0].tolist() == track.status.tolist()


def test_right_cameras_raise_no_doubt(run):
    assert run[2].summary()["doubts"] == []


def test_joints_lie_where_the_hand_is(run, views):
    """The detector is made for photographs; on this drawing its joints, triangulated, are about 1 cm off."""
    track, truth = run[2], views[1]
    seen = track.status != "lost"
    apart = np.linalg.norm(track.joints_3d[seen] - truth.joints_3d[:FRAMES][seen], axis=2)
    assert 1000.0 * apart.mean() < 10.0


def test_a_run_goes_on_from_a_stored_state_as_if_it_had_never_stopped(run, views, tmp_path):
    setup, start, whole = run
    state, first = track_frames(views[0], setup, start, range(5))
    state.save(tmp_path / "state.npz")
    _, second = track_frames(views[0], setup, TrackState.load(tmp_path / "state.npz"), range(5, FRAMES))
    np.testing.assert_array_equal(TrackChunk.join([first, second]).pose, whole.pose)


def test_every_camera_is_compared_with_the_fit_and_with_the_others(run, tmp_path):
    track = run[2]
    errors = track.views
    assert errors is not None
    assert errors.camera_ids.tolist() == ["cam0", "cam1", "cam2"]
    is_lost = track.status == "lost"
    assert np.isnan(errors.fit_px[is_lost]).all()
    assert np.isnan(errors.left_out_px[is_lost]).all()
    assert np.nanmedian(errors.fit_px) < 5.0
    track.save(tmp_path)
    back = load_track(tmp_path)
    assert back.views is not None
    np.testing.assert_array_equal(back.views.left_out_px, errors.left_out_px)
    np.testing.assert_array_equal(back.chunk.seen, track.chunk.seen)
    assert set(json.loads((tmp_path / "summary.json").read_text())["views"]["cam1"]) == {
        "fit_px",
        "left_out_px",
        "outvoted",
        "weight",
    }


def test_rays_go_from_each_camera_to_beside_the_joints_that_it_saw(run, views):
    track, frame = run[2], 2
    shown = describe_frame(views[0], track.setup, track.pose[frame], frame).cameras
    assert [camera.name for camera in shown] == ["cam0", "cam1", "cam2"]
    joints = track.joints_3d[frame]
    for camera, known in zip(shown, views[0].cameras, strict=True):
        np.testing.assert_allclose(camera.outline[:4, 0], np.tile(known.T_world_camera[:3, 3], (4, 1)), atol=1e-6)
        corners = known.project(camera.outline[:4, 1].astype(float))
        right, bottom = known.width - 0.5, known.height - 0.5
        np.testing.assert_allclose(corners, [[-0.5, -0.5], [right, -0.5], [right, bottom], [-0.5, bottom]], atol=0.01)
        assert camera.joints.tolist() == list(range(21))
        np.testing.assert_allclose(camera.rays[:, 0], np.tile(known.T_world_camera[:3, 3], (21, 1)), atol=1e-6)
        ends = camera.rays[:, 1].astype(float)
        assert np.median(np.linalg.norm(ends - joints, axis=1)) < 0.01
        along, away = ends - known.T_world_camera[:3, 3], joints - ends
        np.testing.assert_allclose(np.einsum("ji,ji->j", along, away), 0.0, atol=1e-6)


def test_a_lost_hand_has_no_say_wherever_it_was_last(run, views):
    models = (default_hand("right"), default_hand("left"))
    options = TrackOptions(calibrate=False)
    setup = TrackSetup(("right", "left"), models, "cam0", options, view_ids=("cam0", "cam1", "cam2"))
    right, poses = run[2].pose[1], []
    for shift in (0.0, 0.02, 1.0):
        left = right.copy()
        left[:3] += shift
        pose = np.concatenate([right, left])
        state = TrackState(2, pose, pose, is_lost=True, lost_hands=(1,))
        with make_tools(setup, np.eye(4)) as tools:
            _, result, _ = follow_views(views[0], setup, tools, state)
        assert result.hand_status == ("ok", "lost")
        poses.append(result.pose[: len(right)])
    np.testing.assert_array_equal(poses[1], poses[0])
    np.testing.assert_array_equal(poses[2], poses[0])


def test_one_camera_alone_is_said_to_guess_the_distance(run, views, tmp_path, capsys):
    assert not run[2].summary()["is_distance_guessed"]
    folder = str(views[0].folder)
    assert main(["track", folder, "--out", str(tmp_path), "--cameras", "cam0", "--frames", "0:2"]) == 0
    assert "size and distance are guesses" in capsys.readouterr().out
    assert json.loads((tmp_path / "summary.json").read_text())["colour_cameras"] == ["cam0"]


def test_a_missing_image_of_one_view_is_named(views, tmp_path):
    setup, start = start_tracking(views[0], TrackOptions(calibrate=False))
    path = views[0].image_path("color", 1, "cam2")
    hidden = path.rename(tmp_path / "hidden.png")
    try:
        with pytest.raises(FrameError, match="cam2"):
            track_frames(views[0], setup, start, range(3))
    finally:
        hidden.rename(path)


def test_depth_and_colour_together_are_better_than_either_alone(tmp_path):
    """One camera with depth and colour, two with colour alone; the very hand that was drawn."""
    performance = perform({"right": default_hand("right")}, "open-close", 60, 3, (480, 360))
    write_recording(performance, tmp_path / "hand", RecordingOptions(range(6)), save_npz_model)
    description = json.loads((tmp_path / "hand" / "sequence.json").read_text())
    for camera in description["cameras"][1:]:
        del camera["depth"], camera["depth_scale"]
    (tmp_path / "hand" / "sequence.json").write_text(json.dumps(description))
    sequence, truth = load_sequence(tmp_path / "hand"), load_truth(tmp_path / "hand" / "truth.npz")
    errors = {}
    for name, options in {
        "depth": TrackOptions(calibrate=False, camera="cam0"),
        "colour": TrackOptions(calibrate=False, cameras="cam1,cam2"),
        "both": TrackOptions(calibrate=False, cameras="cam0,cam1,cam2", threads=2),
    }.items():
        setup, state = start_tracking(sequence, options)
        assert setup.view_ids == options.view_ids
        _, chunk = track_frames(sequence, setup, state, range(6))
        track = join_chunks(sequence, setup, [chunk])
        assert "lost" not in track.status
        errors[name] = 1000.0 * np.linalg.norm(track.joints_3d - truth.joints_3d[:6], axis=2).mean()
    assert errors["both"] < errors["depth"] < errors["colour"], errors


def test_a_single_camera_with_depth_is_tracked_as_a_depth_camera(tmp_path):
    performance = perform({"right": default_hand("right")}, "open-close", 60, 2, (320, 240))
    write_recording(performance, tmp_path / "hand", RecordingOptions(range(1)), save_npz_model)
    sequence = load_sequence(tmp_path / "hand")
    assert choose_cameras(sequence, TrackOptions(cameras="cam1")) == ("cam1", ())
    assert choose_cameras(sequence, TrackOptions(cameras="cam1", use_depth=False)) == ("cam1", ("cam1",))
    assert choose_cameras(sequence, TrackOptions(cameras="cam1,cam0")) == ("cam1", ("cam1", "cam0"))


def test_a_camera_that_moved_since_it_was_calibrated_is_named(views, tmp_path):
    folder = tmp_path / "moved"
    shutil.copytree(views[0].folder, folder)
    description = json.loads((folder / "sequence.json").read_text())
    description["cameras"][2]["T_world_camera"][1][3] += 0.1
    (folder / "sequence.json").write_text(json.dumps(description))
    sequence = load_sequence(folder)
    setup, start = start_tracking(sequence, TrackOptions(calibrate=False))
    _, chunk = track_frames(sequence, setup, start, range(4))
    (doubt,) = join_chunks(sequence, setup, [chunk]).summary()["doubts"]
    assert doubt.startswith("cam2 sees ")


def test_of_six_views_all_look_for_a_hand_and_every_other_one_follows_it(tmp_path):
    performance = perform({"right": default_hand("right")}, "wave", 60, 6, (320, 240))
    sequence = write_recording(performance, tmp_path / "hand", RecordingOptions(range(4)), save_npz_model)
    ids = ",".join(camera.id for camera in sequence.cameras)
    setup, state = start_tracking(sequence, TrackOptions(calibrate=False, cameras=ids, use_depth=False))
    _, chunk = track_frames(sequence, setup, state, range(4))
    looks = np.isfinite(chunk.seen[:, :, 0]).all(axis=(2, 3))
    assert looks[0, :2].all()  # not only every other one
    for frame in range(1, 4):
        assert not looks[frame, 1 - frame % 2 :: 2].any()
        assert looks[frame].sum() >= 2
    track = join_chunks(sequence, setup, [chunk])
    assert "lost" not in track.status
    assert track.summary()["doubts"] == []
