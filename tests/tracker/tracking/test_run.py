"""A whole run on a rendered hand: placed, calibrated, followed, saved, and the same whatever its chunks."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from tracker.capture.annotations import Annotations
from tracker.errors import TrackingError
from tracker.fitting.objective import Objective
from tracker.fitting.options import TrackOptions
from tracker.fitting.setup import TrackSetup
from tracker.inspection.frame_view import describe_frame, render_overlay
from tracker.model.default_hand import default_hand
from tracker.model.shape import with_shape
from tracker.tracking.chunk import TrackChunk
from tracker.tracking.follow import track_frames
from tracker.tracking.start import start_tracking
from tracker.tracking.state import TrackState
from tracker.tracking.track import join_chunks, load_track

SAME_MODEL = TrackOptions(calibrate=False)


def test_the_known_pose_comes_back_within_a_millimetre_and_a_half(recorded, run):
    setup, _, _, chunk = run
    track = join_chunks(recorded.sequence, setup, [chunk])
    assert list(track.status) == ["ok"] * 12
    assert recorded.joint_errors(track.frame, track.joints_3d).max() < 1.5e-3  # m


def test_a_hand_is_found_without_annotation(recorded):
    setup, start = start_tracking(recorded.sequence, SAME_MODEL)
    assert not start.is_lost
    _, chunk = track_frames(recorded.sequence, setup, start, range(4))
    track = join_chunks(recorded.sequence, setup, [chunk])
    assert recorded.joint_errors(track.frame, track.joints_3d).max() < 3e-3  # m


def test_annotations_of_other_frames_are_not_looked_at(recorded):
    others = Annotations(tuple(item for item in recorded.annotations.items if item.frame > 0))
    _, with_others = start_tracking(recorded.sequence, SAME_MODEL, annotations=others)
    _, without = start_tracking(recorded.sequence, SAME_MODEL)
    assert np.array_equal(with_others.pose, without.pose)


def test_chunks_through_files_give_the_same_bits_as_one_piece(recorded, run, tmp_path: Path):
    setup, start, end, whole = run
    setup.save(tmp_path)
    start.save(tmp_path / "state.npz")
    chunks = []
    for first in range(0, 12, 5):
        again, state = TrackSetup.load(tmp_path), TrackState.load(tmp_path / "state.npz")
        state, chunk = track_frames(recorded.sequence, again, state, range(first, min(first + 5, 12)))
        state.save(tmp_path / "state.npz")
        chunk.save(tmp_path / f"chunk_{first}.npz")
        chunks.append(TrackChunk.load(tmp_path / f"chunk_{first}.npz"))
    joined = TrackChunk.join(chunks)
    for name in ("frame", "pose", "status", "depth_residual_mm", "silhouette_iou", "score", "iterations", "costs"):
        assert np.array_equal(getattr(joined, name), getattr(whole, name)), name
    assert np.array_equal(state.pose, end.pose)


def test_a_saved_track_holds_what_the_contract_says(recorded, run, tmp_path: Path):
    setup, _, _, chunk = run
    track = join_chunks(recorded.sequence, setup, [chunk])
    track.save(tmp_path)
    with np.load(tmp_path / "track.npz", allow_pickle=False) as arrays:
        shapes = {name: arrays[name].shape for name in arrays.files}
        assert arrays["joint_names"][6] == "right/index_pip"
    assert shapes == {
        "frame": (12,),
        "joint_names": (21,),
        "joints_3d": (12, 21, 3),
        "camera_ids": (1,),
        "joints_2d": (12, 1, 21, 2),
        "object_names": (0,),
        "T_world_object": (12, 0, 4, 4),
        "object_status": (12, 0),
        "pose": (12, 37),
        "status": (12,),
        "hand_names": (1,),
        "hand_status": (12, 1),
        "seconds": (12,),
    }
    summary = json.loads((tmp_path / "summary.json").read_text())
    assert {
        "frames",
        "lost",
        "median_ms",
        "p95_ms",
        "stages_ms",
        "depth_residual_mm",
        "silhouette_iou",
        "threads",
    } <= set(summary)
    assert np.array_equal(load_track(tmp_path).joints_3d, track.joints_3d)


@pytest.mark.slow
def test_another_size_is_calibrated_from_the_first_second(recorded):
    base = default_hand("right")
    assert base.shape is not None
    small = np.zeros(len(base.shape.names))
    small[0] = -1.2
    wrong = with_shape(base, small)
    setup, _ = start_tracking(
        recorded.sequence, TrackOptions(), models={"right": wrong}, annotations=recorded.annotations
    )

    def length(model):
        joints = model.skeleton.joints_rest
        return float(np.linalg.norm(joints[model.hand.joint_bones[9]] - joints[model.hand.joint_bones[0]]))

    error_before = abs(length(wrong) / length(base) - 1.0)
    assert error_before > 0.05
    assert abs(length(setup.models[0]) / length(base) - 1.0) < 0.3 * error_before


def test_an_empty_frame_is_lost_and_the_hand_is_found_again_after_it(recorded, run, tmp_path: Path):
    import cv2

    from tracker.capture.sequence import load_sequence

    for path in recorded.sequence.folder.rglob("*"):
        if path.is_file():
            target = tmp_path / path.relative_to(recorded.sequence.folder)
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(path.read_bytes())
    blinded = load_sequence(tmp_path)
    for index in (4, 5):
        cv2.imwrite(str(blinded.image_path("depth", index, "cam0")), np.zeros((480, 640), np.uint16))
    setup, start, _, _ = run
    _, chunk = track_frames(blinded, setup, start, range(9))
    track = join_chunks(blinded, setup, [chunk])
    assert list(track.status) == ["ok"] * 4 + ["lost", "lost", "recovered", "ok", "ok"]
    assert recorded.joint_errors(track.frame, track.joints_3d)[6:].max() < 4e-3  # m


def test_a_frame_is_described_for_the_viewer(recorded, run):
    setup, _, _, chunk = run
    view = describe_frame(recorded.sequence, setup, chunk.pose[3], 3)
    assert view.cloud.shape == view.colors.shape
    assert view.models[0].joints.shape == (21, 3)
    assert set(view.correspondences) == {*Objective().terms, "collision", "salient"}, "the terms of LO+SC"
    lengths = np.linalg.norm(np.diff(view.correspondences["model_to_data"], axis=1), axis=-1)
    assert lengths.max() <= 0.010 + 1e-6  # m, the term's own limit


def test_the_overlay_covers_the_hand_and_nothing_else(recorded, run):
    setup, _, _, chunk = run
    image = render_overlay(recorded.sequence, setup, chunk.pose[3], 3, "cam0")
    drawn, seen = image[:, :, 3] > 0, recorded.sequence.depth_raw(3, "cam0") > 0
    assert np.count_nonzero(drawn & seen) / np.count_nonzero(drawn | seen) > 0.9


@pytest.mark.parametrize(
    "values",
    [{"iterations": 0}, {"terms": "XYZ"}, {"iterations": True}, {"nonsense": 1}, {"last_frame": 2, "first_frame": 5}],
)
def test_options_that_make_no_sense_are_refused(values):
    with pytest.raises(TrackingError):
        TrackOptions.from_json(values)


def test_frames_that_do_not_exist_are_refused(recorded):
    with pytest.raises(TrackingError, match="0 to 11"):
        start_tracking(recorded.sequence, TrackOptions(last_frame=99))
