"""The report of a training: which hands and poses fit badly, and in which order."""

import numpy as np
import pytest
from scipy.sparse import csr_array

from tests.tracker.training.fingers import PARENTS, crude_regressor, make_fingers
from tracker.model.skinning import keep_heaviest
from tracker.training.learn import Learnt
from tracker.training.options import TrainingOptions
from tracker.training.pose_fit import Poses
from tracker.training.report import describe_training
from tracker.training.rig import Rig
from tracker.training.spaces import find_space
from tracker.training.training_set import TrainingSet

ERRORS = np.array([0.001, 0.002, 0.003, 0.004, 0.0, 0.012])
"""m, of two people in three poses."""


@pytest.fixture(scope="module")
def report():
    fingers = make_fingers(people=2, poses=3)
    regressor = csr_array(crude_regressor(fingers.templates[0]))
    poses = Poses(fingers.rotations, fingers.translations, ERRORS)
    rig = Rig(PARENTS, keep_heaviest(fingers.weights), fingers.directions)
    learnt = Learnt(fingers.templates, fingers.joints, poses, rig, regressor)
    names = np.array(["Ada"] * 3 + ["Bob"] * 3)
    used = TrainingSet(fingers.targets, names, np.array(["flat", "fist", "pinch"] * 2), np.zeros(6, dtype=bool))
    space = find_space(np.random.default_rng(0).normal(size=(6, 4)))
    return describe_training(
        used, fingers.owners, {"Cem": 2}, learnt, space, space, [0.004, 0.002], TrainingOptions(), {"poses": 1.5}
    )


def test_distances_are_root_mean_squares_in_mm(report):
    assert report["residual_mm"] == pytest.approx(1e3 * np.sqrt(np.mean(ERRORS**2)), abs=1e-4)
    assert report["rounds_mm"] == [4.0, 2.0]
    assert report["by_hand"]["Ada"] == {"registrations": 3, "residual_mm": pytest.approx(2.1602, abs=1e-4)}
    assert report["by_pose"]["pinch"]["residual_mm"] == pytest.approx(1e3 * np.sqrt((9e-6 + 144e-6) / 2), abs=1e-4)


def test_the_worst_come_first_with_their_hand_and_pose(report):
    worst = [(row["hand"], row["pose"], row["residual_mm"]) for row in report["worst"]]
    assert worst[0] == ("Bob", "pinch", 12.0) and worst[-1] == ("Bob", "fist", 0.0)
    assert [row[2] for row in worst] == sorted((row[2] for row in worst), reverse=True)


def test_who_was_left_out_and_what_it_took_is_said(report):
    assert (report["registrations"], report["people"], report["hands"]) == (6, 2, 2)
    assert report["left_out"] == {"Cem": 2} and report["seconds"] == {"poses": 1.5}
    assert report["options"] == TrainingOptions().describe()
    assert report["shape_space"][-1] == pytest.approx(1.0, abs=1e-4)


def test_the_regressors_distance_from_the_learnt_joints_is_told(report):
    assert 0.0 < report["joint_regressor_mm"] < 20.0
