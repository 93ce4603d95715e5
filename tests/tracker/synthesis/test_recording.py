"""A synthetic recording is a recording like any other, exact in its truth and the same for the same seed."""

from __future__ import annotations

import hashlib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tracker.capture.truth import load_truth
from tracker.errors import SequenceError
from tracker.synthesis.camera_ring import surround
from tracker.synthesis.performance import render_moment
from tracker.synthesis.recording import RecordingOptions, write_recording
from tracker.synthesis.sensor import StructuredLight


def save_nothing(model, path: Path) -> None:
    path.write_bytes(model.name.encode())


def digests(folder: Path) -> dict[str, str]:
    files = sorted(path for path in folder.rglob("*") if path.is_file())
    return {str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest() for path in files}


def test_exact_images_come_back_as_rendered(performance, tmp_path):
    options = RecordingOptions(range(0, 6, 2), sensor=None)
    sequence = write_recording(performance, tmp_path / "exact", options, save_nothing)
    assert (sequence.frame_count, sequence.fps) == (3, 15.0)
    np.testing.assert_allclose(sequence.camera("cam0").T_world_camera, performance.camera.T_world_camera)
    for frame in range(3):
        image = sequence.frame(frame, "cam0")
        moment = render_moment(performance, 2 * frame)
        assert image.depth is not None
        np.testing.assert_allclose(image.depth, moment.depth, atol=0.00005 + 1e-7)  # half of the 0.1 mm unit


def test_truth_holds_the_joints_and_the_motion_of_every_frame(performance, tmp_path):
    write_recording(performance, tmp_path / "r", RecordingOptions(range(1, 6, 2)), save_nothing)
    truth = load_truth(tmp_path / "r" / "truth.npz")
    np.testing.assert_array_equal(truth.frame, [0, 1, 2])
    np.testing.assert_array_equal(truth.source_frame, [1, 3, 5])
    assert truth.joint_names == performance.joint_names
    for frame, index in enumerate(truth.source_frame):
        moment = render_moment(performance, int(index))
        np.testing.assert_array_equal(truth.joints_3d[frame], moment.joints)
        np.testing.assert_array_equal(truth.joints_2d[frame, 0], moment.pixels)
        np.testing.assert_array_equal(truth.T_world_object[frame, 0], performance.actors[0].T_world_model(int(index)))


def test_several_cameras_see_the_same_joints_at_the_same_moments(performance, tmp_path):
    others = surround(performance.camera, performance.actors[0].joints(0, performance.actors[0].vertices(0))[0], 2)
    several = replace(performance, other_cameras=others)
    sequence = write_recording(several, tmp_path / "r", RecordingOptions(range(2), sensor=None), save_nothing)
    assert [camera.id for camera in sequence.cameras] == ["cam0", "cam1", "cam2"]
    truth = load_truth(tmp_path / "r" / "truth.npz")
    for number, camera in enumerate(sequence.cameras):
        for frame in range(2):
            moment = render_moment(performance.seen_by(camera), frame)
            np.testing.assert_allclose(sequence.frame(frame, camera.id).depth, moment.depth, atol=0.0001)
            np.testing.assert_array_equal(truth.joints_2d[frame, number], camera.project(truth.joints_3d[frame]))


def test_the_first_camera_records_the_same_whether_others_do_or_not(performance, tmp_path):
    several = replace(performance, other_cameras=surround(performance.camera, np.array([0.1, -0.2, 0.7]), 1))
    write_recording(performance, tmp_path / "one", RecordingOptions(range(2)), save_nothing)
    write_recording(several, tmp_path / "two", RecordingOptions(range(2)), save_nothing)
    one, two = digests(tmp_path / "one"), digests(tmp_path / "two")
    assert all(one[path] == two[path] for path in one if path.endswith(".png"))
    assert two["depth/000000.png"] != two["cam1/depth/000000.png"]


def test_an_object_is_placed_where_it_is_in_the_first_frame(performance, tmp_path):
    sequence = write_recording(performance, tmp_path / "r", RecordingOptions(range(2, 4)), save_nothing)
    (item,) = sequence.objects
    np.testing.assert_allclose(item.T_world_object, performance.actors[0].T_world_model(2))
    assert set(item.joints) == {"bone_0", "bone_1", "bone_2"}
    assert sequence.object_path("tube").is_file()


def test_same_seed_gives_the_same_bytes_and_another_seed_other_images(performance, tmp_path):
    for name, seed in (("a", 3), ("b", 3), ("c", 4)):
        write_recording(performance, tmp_path / name, RecordingOptions(range(3), seed=seed), save_nothing)
    first, again, other = (digests(tmp_path / name) for name in "abc")
    assert first == again
    assert all(
        first[f"{kind}/00000{n}.png"] != other[f"{kind}/00000{n}.png"] for kind in ("depth", "color") for n in range(3)
    )


def test_the_noise_of_a_moment_does_not_depend_on_what_else_is_recorded(performance, tmp_path):
    write_recording(performance, tmp_path / "all", RecordingOptions(range(6)), save_nothing)
    write_recording(performance, tmp_path / "some", RecordingOptions(range(4, 6)), save_nothing)
    assert digests(tmp_path / "all")["depth/000004.png"] == digests(tmp_path / "some")["depth/000000.png"]


def test_a_wall_behind_fills_the_image_but_for_what_the_projector_cannot_reach(performance, tmp_path):
    sensor = StructuredLight(random_loss=0.0, edge_loss=0.0)
    options = RecordingOptions(range(1), sensor=sensor, background=0.6)
    depth = write_recording(performance, tmp_path / "r", options, save_nothing).frame(0, "cam0").depth
    assert depth is not None
    assert np.median(depth) == pytest.approx(0.6, abs=0.002)
    assert 0.005 < np.mean(depth == 0) < 0.2


def test_a_folder_that_is_there_is_left_alone(performance, tmp_path):
    (tmp_path / "r").mkdir()
    (tmp_path / "r" / "mine.txt").write_text("mine")
    with pytest.raises(SequenceError, match="is already there"):
        write_recording(performance, tmp_path / "r", RecordingOptions(range(2)), save_nothing)
    assert [path.name for path in tmp_path.rglob("*")] == ["r", "mine.txt"]


def test_a_recording_that_fails_half_way_leaves_nothing(performance, tmp_path):
    (actor,) = performance.actors
    broken = replace(performance, actors=(replace(actor, Ms=np.full_like(actor.Ms, np.nan)),))
    with pytest.raises(Exception, match=r"."):
        write_recording(broken, tmp_path / "r", RecordingOptions(range(2)), save_nothing)
    assert list(tmp_path.iterdir()) == []
