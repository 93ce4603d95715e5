"""What is lost is said to be lost, the rest is followed on, and both are put right when it comes back."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tracker.capture.annotations import load_annotations
from tracker.capture.frame import Frame
from tracker.capture.truth import load_truth
from tracker.fitting.attempt import UNSETTLED, attempt_fit, look, try_again
from tracker.fitting.finger_search import swap_fingers
from tracker.fitting.frame_fit import FitOptions
from tracker.fitting.objective import Objective
from tracker.fitting.options import TrackOptions
from tracker.fitting.quality import MISFIT
from tracker.model.default_hand import default_hand
from tracker.model.npz_files import save_npz_model
from tracker.search.tools import Tools
from tracker.synthesis.motion import perform
from tracker.synthesis.recording import RecordingOptions, write_recording
from tracker.tracking.follow import follow_frame
from tracker.tracking.patience import Patience
from tracker.tracking.start import start_tracking
from tracker.tracking.state import TrackState

TOOLS = Tools(Objective(), None, None)


@pytest.fixture(scope="module")
def two_hands(tmp_path_factory):
    folder = tmp_path_factory.mktemp("two") / "hands"
    performance = perform({side: default_hand(side) for side in ("right", "left")}, "wave", 60)
    sequence = write_recording(performance, folder, RecordingOptions(range(6)), save_npz_model)
    annotations = load_annotations(sequence.annotations_path)
    setup, state = start_tracking(sequence, TrackOptions(calibrate=False), annotations=annotations)
    return sequence, load_truth(folder / "truth.npz"), setup, state


def errors(truth, setup, pose: np.ndarray, frame: int) -> np.ndarray:
    """(H,) mean distance of each hand's joints from the truth, m."""
    posed = setup.scene.pose_at(pose)
    found = []
    for index, name in enumerate(setup.names):
        own = [place for place, joint in enumerate(truth.joint_names) if joint.startswith(f"{name}/")]
        found.append(np.linalg.norm(posed.landmarks(index) - truth.joints_3d[frame, own], axis=1).mean())
    return np.array(found)


def test_a_followed_hand_has_no_misfit(recorded, run):
    setup, _, _, chunk = run
    frame, camera = setup.read(recorded.sequence, 3)
    seen = look(frame, camera, setup, chunk.pose[3])
    attempt = attempt_fit(setup, seen, chunk.pose[3], chunk.pose[3], Objective(), FitOptions())
    assert attempt.misfit < UNSETTLED
    assert attempt.lost == ()


def test_a_finger_that_is_elsewhere_is_a_lost_hand(recorded, run):
    setup, _, _, chunk = run
    frame, camera = setup.read(recorded.sequence, 0)
    wrong = chunk.pose[0].copy()
    wrong[6:] = np.clip(wrong[6:] + 0.7, setup.scene.lower[6:], setup.scene.upper[6:])
    seen = look(frame, camera, setup, wrong)
    attempt = attempt_fit(setup, seen, wrong, wrong, Objective(), FitOptions(iterations=0))
    assert attempt.misfit > MISFIT
    assert attempt.lost == (0,)


@pytest.mark.parametrize("pair", range(3))
def test_swapped_fingers_are_put_right(recorded, run, pair: int):
    setup, _, _, chunk = run
    frame, camera = setup.read(recorded.sequence, 3)
    rng = np.random.default_rng(pair)
    start = swap_fingers(chunk.pose[3], 0, setup.models[0])[pair]
    start[6:] += np.deg2rad(10.0) * rng.choice([-1.0, 1.0], len(start) - 6)
    seen = look(frame, camera, setup, start)
    best = try_again(setup, seen, start, Objective(), Objective(), FitOptions())
    posed = setup.scene.pose_at(best.pose)
    error = np.linalg.norm(posed.landmarks(0) - recorded.truth.joints_3d[3], axis=1).mean()
    assert best.misfit < UNSETTLED
    assert error < 2e-3  # m


@pytest.mark.parametrize("gone", [0, 1])
def test_one_hand_goes_and_the_other_is_followed(two_hands, monkeypatch, gone: int):
    sequence, truth, setup, state = two_hands
    read = type(setup).read

    def read_without(self, sequence, index):
        frame, camera = read(self, sequence, index)
        if index not in (2, 3):
            return frame, camera
        own = [j for j, name in enumerate(truth.joint_names) if name.startswith(f"{setup.names[gone]}/")]
        other = [j for j in range(len(truth.joint_names)) if j not in own]
        columns = [truth.joints_2d[index, 0, who, 0].mean() for who in (own, other)]
        away = np.arange(camera.width) < np.mean(columns)
        hidden = away if columns[0] < columns[1] else ~away
        return Frame(index, frame.camera, frame.color, np.where(hidden[None], np.float32(0.0), frame.depth)), camera

    monkeypatch.setattr(type(setup), "read", read_without)
    statuses = []
    for index in range(6):
        state, result = follow_frame(sequence, setup, TOOLS, state, recover=True)
        statuses.append(result.status)
        assert result.hand_status[1 - gone] == "ok"
        assert result.hand_status[gone] == result.status
        off = errors(truth, setup, result.pose, index)
        assert off[1 - gone] < 2e-3, f"the other hand at frame {index}"  # m
        if result.status != "lost":
            assert off[gone] < 3e-3  # m
    assert statuses == ["ok", "ok", "lost", "lost", "recovered", "ok"]


def test_the_state_remembers_which_hand_is_lost(two_hands, tmp_path):
    _, _, _, state = two_hands
    lost = replace(state, is_lost=True, lost_hands=(1,), second_try=Patience(1, 4))
    lost.save(tmp_path / "state.npz")
    again = TrackState.load(tmp_path / "state.npz")
    assert (again.is_lost, again.lost_hands, again.second_try) == (True, (1,), Patience(1, 4))


@pytest.mark.parametrize("shift", [-0.12, -0.08, -0.05, 0.05, 0.08, 0.12])
@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_hand_that_moved_out_of_its_region_is_followed_or_said_to_be_lost(recorded, run, shift: float, axis: int):
    setup, _, _, chunk = run
    aside = chunk.pose[3].copy()
    aside[axis] += shift
    _, result = follow_frame(recorded.sequence, setup, TOOLS, TrackState(3, aside, aside), recover=False)
    error = np.linalg.norm(setup.scene.pose_at(result.pose).landmarks(0) - recorded.truth.joints_3d[3], axis=1).mean()
    assert result.status == "lost" or error < 3e-3  # m
