"""A real recording that no one described: a right hand holds and turns a white box."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tracker.capture.import_options import ImportOptions
from tracker.capture.import_run import run_import
from tracker.capture.sequence import Sequence, load_sequence
from tracker.fitting.options import TrackOptions
from tracker.fitting.setup import TrackSetup
from tracker.model.joints import FINGERS, HAND_JOINTS
from tracker.tracking.follow import track_frames
from tracker.tracking.frame_result import FrameResult
from tracker.tracking.start import start_tracking

pytestmark = pytest.mark.shared_data

FRAMES = 21


@pytest.fixture(scope="module")
def box(shared_data: Path, tmp_path_factory: pytest.TempPathFactory) -> Sequence:
    folder = tmp_path_factory.mktemp("box") / "recording"
    how = ImportOptions(fps=30.0, fx=238.95, fy=238.95, cx=160.0, cy=120.0, depth_scale=0.001, hands=("right",))
    run_import(shared_data / "uvr_cube_white", folder, "rgbd_folder", how)
    return load_sequence(folder)


@pytest.fixture(scope="module")
def run(box: Sequence) -> tuple[TrackSetup, list[FrameResult]]:
    options = TrackOptions(calibrate=False, last_frame=FRAMES - 1)
    setup, state = start_tracking(box, options)
    results: list[FrameResult] = []
    track_frames(box, setup, state, range(FRAMES), lambda _, result: results.append(result))
    return setup, results


def test_a_hand_with_an_unknown_box_is_found_and_held_without_any_mark(run) -> None:
    _, results = run
    assert sum(result.status != "lost" for result in results) >= 0.8 * FRAMES
    assert results[-1].status == "ok"


def test_fingertips_that_people_marked_are_where_the_track_has_them(run, box: Sequence, shared_data: Path) -> None:
    setup, results = run
    marked = json.loads((shared_data / "uvr_cube_white" / "tips.json").read_text())["frames"]
    camera = box.cameras[0]
    apart = []
    for index, result in enumerate(results):
        joints = camera.project(setup.scene.pose_at(result.pose).landmarks(0))
        for finger, place in marked.get(str(index), {}).items():
            assert finger in FINGERS
            apart.append(np.linalg.norm(joints[HAND_JOINTS.index(f"{finger}_tip")] - place))
    assert len(apart) >= 3
    assert max(apart) < 8.0


def test_a_broken_off_run_goes_on_as_if_nothing_had_been(box: Sequence, run, tmp_path: Path) -> None:
    setup, results = run
    _, state = start_tracking(box, setup.options)
    state, _ = track_frames(box, setup, state, range(5))
    state.save(tmp_path / "state.npz")
    _, chunk = track_frames(box, setup, type(state).load(tmp_path / "state.npz"), range(5, 9))
    for place, result in enumerate(results[5:9]):
        np.testing.assert_array_equal(chunk.pose[place], result.pose)


def test_two_threads_give_the_bits_of_one_beside_the_detector(box: Sequence, run) -> None:
    setup, results = run
    _, state = start_tracking(box, setup.options)
    two = replace(setup, options=replace(setup.options, threads=2))
    _, chunk = track_frames(box, two, state, range(9))
    np.testing.assert_array_equal(chunk.pose, [result.pose for result in results[:9]])
