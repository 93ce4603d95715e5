import numpy as np
import pytest

from tracker.cli.__main__ import main
from tracker.synthesis.scans.arrange import arrange
from tracker.synthesis.scans.generate import generate_truth
from tracker.synthesis.scans.motions import _joints_of, follow_joints, load_motion_angles
from tracker.synthesis.scans.subject import load_subject


@pytest.mark.parametrize("pose", ["half_curl", "point", "flat_spread"])
def test_another_subject_takes_on_the_pose_of_joints(pose):
    giver, _, angles = arrange(3, pose, is_varied=False)
    taker = load_subject(30)
    found = follow_joints(taker, _joints_of(giver, angles))

    def bends(subject, angles):
        bones = np.diff(_joints_of(subject, angles)[1:].reshape(5, 4, 3), axis=1)
        bones /= np.linalg.norm(bones, axis=2, keepdims=True)
        return np.degrees(np.arccos(np.clip(np.einsum("fbx,fbx->fb", bones[:, 1:], bones[:, :-1]), -1.0, 1.0)))

    assert np.abs(bends(taker, found) - bends(giver, angles)).max() < 12.0


@pytest.mark.shared_data
def test_scans_of_a_motion_are_written_by_the_command(shared_data, tmp_path):
    command = ["synthesize-scans", "--subjects", "7", "--poses", "01-100", "--sides", "left", "--points", "2000"]
    assert main([*command, "--out", str(tmp_path / "x")]) == 2
    assert main([*command, "--motions", str(shared_data / "ijcv16"), "--out", str(tmp_path / "scans")]) == 0
    with np.load(tmp_path / "scans" / "truth" / "subject07_01-100_left_0.npz") as truth:
        assert str(truth["pose_name"]) == "01-100"


@pytest.mark.shared_data
def test_people_move_as_in_a_motion_of_t16(shared_data):
    poses = [load_motion_angles(shared_data / "ijcv16", "09", "right", moment, 7) for moment in (5, 60)]
    hands = [generate_truth(7, pose).joints for pose in poses]
    assert np.linalg.norm(hands[0] - hands[1], axis=1).max() > 0.01
