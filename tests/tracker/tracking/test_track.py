"""A finished track: what follows from its poses, what its summary counts, and its folder."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.tracker.export.conftest import FIRST, FRAMES, Moved, make_moved
from tests.tracker.toys import tube
from tracker.errors import TrackingError
from tracker.model.default_hand import default_hand
from tracker.tracking.chunk import TrackChunk
from tracker.tracking.frame_result import STATUSES
from tracker.tracking.track import Track, join_chunks, load_track


@pytest.fixture(scope="module")
def moved() -> Moved:
    """A right hand, a bending rope and a rigid ball before two cameras."""
    return make_moved({"right": default_hand("right"), "rope": tube(bones=3), "ball": tube(bones=1)})


@pytest.fixture(scope="module")
def measured(moved: Moved) -> Track:
    """The same with numbers of every kind in its columns."""
    chunk = replace(
        moved.track.chunk,
        seconds=np.array([0.010, 0.020, 0.030, 0.040, 0.050, 0.300]),
        depth_residual_mm=np.array([1.0, 2.0, 50.0, 60.0, np.nan, 4.0]),
        stage_names=np.array(["fitting", "reading"]),
        stages=np.array([[0.002 * n, 0.001] for n in range(FRAMES)]),
        hand_status=np.array([[0], [0], [1], [2], [0], [0]], dtype=np.int8),
        object_status=np.array([[0, 3], [0, 3], [1, 3], [2, 0], [0, 0], [0, 0]], dtype=np.int8),
    )
    return replace(moved.track, chunk=chunk)


def slice_chunk(chunk: TrackChunk, rows: slice) -> TrackChunk:
    names = ("frame", "pose", "status", "seconds", "depth_residual_mm", "silhouette_iou", "score", "iterations")
    return replace(chunk, **{name: getattr(chunk, name)[rows] for name in (*names, "costs", "stages")})


def test_joints_and_motions_are_those_of_the_scene_at_each_pose(moved: Moved) -> None:
    track, scene = moved.track, moved.track.setup.scene
    assert track.joints_3d.shape == (FRAMES, 21 + 3, 3) and len(track.joint_names) == 21 + 3
    assert track.T_world_object.shape == (FRAMES, 2, 4, 4), "of the rope and of the ball"
    for row, pose in enumerate(track.pose):
        posed = scene.pose_at(pose)
        np.testing.assert_allclose(track.joints_3d[row], np.concatenate([posed.landmarks(0), posed.landmarks(1)]))
        for place, model in enumerate(track.setup.objects):
            np.testing.assert_allclose(track.T_world_object[row, place], posed.T_world_model(model))


def test_joints_are_projected_into_every_camera_of_the_recording_and_nan_behind_it(moved: Moved) -> None:
    track = moved.track
    assert track.camera_ids == ("cam0", "b,1")
    for place, camera in enumerate(moved.sequence.cameras):
        in_camera = (
            np.einsum("ij,tnj->tni", camera.T_camera_world[:3, :3], track.joints_3d) + camera.T_camera_world[:3, 3]
        )
        is_before = in_camera[..., 2] > 0.0
        pixels = in_camera / in_camera[..., 2:] @ camera.K.T
        np.testing.assert_allclose(track.joints_2d[:, place][is_before], pixels[is_before][:, :2])
        assert np.isnan(track.joints_2d[:, place][~is_before]).all()
    assert np.isnan(track.joints_2d[:, 1]).any() and not np.isnan(track.joints_2d[:, 0]).any()


def test_chunks_in_order_are_one_track_and_a_gap_or_a_repetition_is_refused(moved: Moved) -> None:
    whole, setup = moved.track.chunk, moved.track.setup
    first, second = slice_chunk(whole, slice(0, 4)), slice_chunk(whole, slice(4, None))
    joined = join_chunks(moved.sequence, setup, [first, second])
    np.testing.assert_array_equal(joined.joints_3d, moved.track.joints_3d)
    np.testing.assert_array_equal(joined.frame, np.arange(FIRST, FIRST + FRAMES))
    for bad in ([second, first], [first, first], [slice_chunk(whole, slice(0, 2)), second]):
        with pytest.raises(TrackingError, match="must follow one another without a gap"):
            join_chunks(moved.sequence, setup, bad)


def test_statuses_are_words_and_those_of_hands_are_none_in_old_tracks(moved: Moved, measured: Track) -> None:
    assert measured.status.tolist() == ["ok", "ok", "lost", "recovered", "ok", "ok"]
    assert measured.hand_status[:, 0].tolist() == measured.status.tolist() and set(measured.status) == set(STATUSES)
    assert measured.object_status[2].tolist() == ["lost", "hidden"]
    assert moved.track.hand_status.size == moved.track.object_status.size == 0


def test_a_summary_counts_frames_and_takes_medians_of_those_that_went_well(measured: Track) -> None:
    told = measured.summary()
    assert (told["frames"], told["lost"], told["recovered"]) == (FRAMES, 1, 1)
    assert (told["median_ms"], told["p95_ms"]) == (35.0, 237.5)
    assert told["stages_ms"] == {"fitting": 5.0, "reading": 1.0}
    assert told["depth_residual_mm"] == 2.0, "of 1, 2 and 4: lost frames and those without a number do not count"
    assert told["silhouette_iou"] is None, "there was nothing to compare in any frame"
    assert told["objects"]["rope"] == {"ok": 4, "lost": 1, "recovered": 1, "hidden": 0}
    assert told["objects"]["ball"] == {"ok": 3, "lost": 0, "recovered": 0, "hidden": 3}
    assert (told["detector"], told["views"], told["doubts"], told["colour_cameras"]) == (None, {}, [], [])
    assert json.loads(json.dumps(told, allow_nan=False)) == told


def test_a_saved_track_comes_back_with_the_same_bits_and_leaves_nothing_half_written(
    measured: Track, tmp_path: Path
) -> None:
    measured.save(tmp_path / "deep" / "track")
    again = load_track(tmp_path / "deep" / "track")
    for name, array in measured.arrays().items():
        np.testing.assert_array_equal(again.arrays()[name], array, err_msg=name)
    assert (
        again.summary() == measured.summary() == json.loads((tmp_path / "deep" / "track" / "summary.json").read_text())
    )
    assert again.views is None
    assert not [path.name for path in (tmp_path / "deep" / "track").rglob("*") if path.name.startswith(".")]


def test_a_track_is_saved_over_an_older_one(moved: Moved, measured: Track, tmp_path: Path) -> None:
    moved.track.save(tmp_path)
    measured.save(tmp_path)
    assert load_track(tmp_path).summary()["median_ms"] == 35.0


def test_a_folder_that_lacks_a_file_or_an_array_is_refused(measured: Track, tmp_path: Path) -> None:
    measured.save(tmp_path)
    arrays = {name: array for name, array in measured.arrays().items() if name != "joints_2d"}
    np.savez(tmp_path / "track.npz", **arrays)
    with pytest.raises(TrackingError, match="joints_2d"):
        load_track(tmp_path)
    (tmp_path / "track.npz").unlink()
    with pytest.raises(TrackingError, match=r"track\.npz"):
        load_track(tmp_path)


def test_a_track_of_a_rigid_thing_alone_has_no_joints() -> None:
    track = make_moved({"ball": tube(bones=1)}).track
    assert track.joint_names == () and track.joints_3d.shape == (FRAMES, 0, 3)
    assert track.joints_2d.shape == (FRAMES, 2, 0, 2) and track.T_world_object.shape == (FRAMES, 1, 4, 4)
