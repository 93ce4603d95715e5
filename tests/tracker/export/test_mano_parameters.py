"""The parameters, put through MANO's kinematics, give the hand's joints and bones again."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tests.tracker.export.conftest import make_moved
from tracker.export.export import export_track
from tracker.export.mano_parameters import MANO_JOINTS, find_mano_axes, find_mano_parameters
from tracker.model.default_hand import default_hand
from tracker.model.joints import HAND_JOINTS

SIDES = ("right", "left")


def run_mano_kinematics(arrays: dict[str, np.ndarray], side: str, row: int) -> tuple[np.ndarray, np.ndarray]:
    """(16, 3) joints, world, m, and (16, 3, 3) rotations from MANO's axes to world, [R17] Eq. 2-4."""
    rest = arrays[f"{side}_joints_rest"]
    turns = np.concatenate(
        [arrays[f"{side}_global_orient"][row, None], arrays[f"{side}_hand_pose"][row].reshape(15, 3)]
    )
    local = Rotation.from_rotvec(turns).as_matrix()
    joints, Rs = np.zeros((16, 3)), np.zeros((16, 3, 3))
    for joint in range(16):
        if joint == 0:
            Rs[0], joints[0] = local[0], rest[0] + arrays[f"{side}_transl"][row]
            continue
        parent = 0 if joint % 3 == 1 else joint - 1
        Rs[joint] = Rs[parent] @ local[joint]
        joints[joint] = joints[parent] + Rs[parent] @ (rest[joint] - rest[parent])
    return joints, Rs


@pytest.mark.parametrize("side", SIDES)
def test_bones_point_where_ours_do(moved, side: str):
    track, arrays = moved.track, find_mano_parameters(moved.track)
    index = track.setup.names.index(side)
    model, bones = track.setup.models[index], track.setup.scene.bone_slices[index]
    assert model.hand is not None
    ours = [model.hand.joint_bones[HAND_JOINTS.index(name)] for name in ("wrist", *MANO_JOINTS)]
    for row, pose in enumerate(track.pose):
        Ms = track.setup.scene.pose_at(pose).Ms[bones]
        _, Rs = run_mano_kinematics(arrays, side, row)
        assert np.allclose(Rs @ find_mano_axes(model).T, Ms[ours, :, :3], atol=1e-9)


@pytest.mark.parametrize("side", SIDES)
def test_joints_come_back_where_the_metacarpals_stand_still(side: str):
    hand = default_hand(side)
    moved = make_moved({side: hand})
    still = [f"{finger}_metacarpal" for finger in ("index", "middle", "ring", "little")]
    bones = [hand.skeleton.bone_names[bone] for bone in hand.skeleton.dof_bones]
    pose = moved.track.pose.copy()
    pose[:, 6:][:, [bone in still for bone in bones]] = 0.0
    arrays = find_mano_parameters(_with_pose(moved, pose))
    for row in range(len(pose)):
        landmarks = moved.track.setup.scene.pose_at(pose[row]).landmarks(0)
        joints, _ = run_mano_kinematics(arrays, side, row)
        expected = landmarks[[HAND_JOINTS.index(name) for name in ("wrist", *MANO_JOINTS)]]
        assert np.abs(joints - expected).max() < 1e-9  # m


@pytest.mark.parametrize(("side", "sign"), [("right", -1.0), ("left", 1.0)])
def test_fingers_thumb_and_back_lie_along_the_axes_of_mano(side: str, sign: float):
    hand = default_hand(side)
    R = find_mano_axes(hand)
    assert np.allclose(R.T @ R, np.eye(3)) and np.linalg.det(R) == pytest.approx(1.0)
    joints = hand.skeleton.joints_rest[hand.hand.joint_bones[[0, 9, 5, 17]]] @ R  # type: ignore[union-attr]
    forward, across = joints[1] - joints[0], joints[2] - joints[3]
    assert forward[0] * sign > 0.99 * np.linalg.norm(forward)
    assert across[2] > 0.9 * np.linalg.norm(across)
    assert (np.array([0.0, 0.0, 1.0]) @ R)[1] > 0.9  # out of the back of the default hand


def test_a_hand_at_rest_has_no_pose_and_a_bent_joint_is_the_one_that_turns():
    one = make_moved({"right": default_hand("right")})
    pose = np.zeros_like(one.track.pose)
    skeleton = one.track.setup.models[0].skeleton
    flexed = [skeleton.bone_names[bone] == "ring_middle" for bone in skeleton.dof_bones]
    pose[1:, 6:][:, flexed] = 0.7
    arrays = find_mano_parameters(_with_pose(one, pose))
    assert np.abs(arrays["right_hand_pose"][0]).max() < 1e-12
    turned = np.linalg.norm(arrays["right_hand_pose"][1].reshape(15, 3), axis=1)
    assert np.flatnonzero(turned > 1e-9).tolist() == [MANO_JOINTS.index("ring_pip")]
    assert turned.max() == pytest.approx(0.7)


def test_the_file_needs_no_pickle_and_says_what_is_not_comparable(moved, tmp_path: Path):
    export_track(moved.track, moved.sequence, "mano", tmp_path / "mano.npz")
    with np.load(tmp_path / "mano.npz", allow_pickle=False) as arrays:
        shapes = {name: arrays[name].shape for name in arrays}
        assert "Not comparable" in str(arrays["note"])
        assert not arrays["left_betas"].any()
        assert arrays["joint_names"].tolist()[7:10] == ["little_mcp", "little_pip", "little_dip"]
    hand = {"global_orient": (6, 3), "hand_pose": (6, 45), "transl": (6, 3), "betas": (10,), "joints_rest": (16, 3)}
    expected = {f"{side}_{key}": shape for side in SIDES for key, shape in hand.items()}
    assert shapes == {**expected, "frame": (6,), "status": (6,), "joint_names": (16,), "note": ()}


def _with_pose(moved, pose: np.ndarray):
    return dataclasses.replace(moved.track, chunk=dataclasses.replace(moved.track.chunk, pose=pose))
