"""The body in files and packed: a person, poses by joints and hands, and motions that last as long as they say."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pytest
import trimesh

from server.bodies.schemas import BodyExport, BodyFrame, BodyPoses
from server.bodies.service import describe_body, pack_body, pack_poses, read_motion, write_poses
from server.errors import InvalidError
from tests.server.packed_arrays import unpack_arrays
from tracker.model.body_model import body_model
from tracker.model.body_motion import BodyMotion, save_body_motion


def pose(*frames: BodyFrame, shape: list[float] | None = None) -> np.ndarray:
    """(N, V, 3) m."""
    arrays, _ = unpack_arrays(pack_poses("neutral", BodyPoses(shape=shape or [], frames=list(frames))))
    return arrays["vertices"]


def test_the_joints_are_a_tree_and_the_landmarks_lie_on_the_body() -> None:
    told = describe_body("neutral")
    assert len(told.joints) == len(told.parents) == 52 and told.parents[0] == -1
    assert all(parent < number for number, parent in enumerate(told.parents))
    assert told.landmarks and all(0 <= vertex < told.vertices for vertex in told.landmarks.values())
    assert told.provenance


def test_the_mesh_at_rest_is_closed_of_its_population_and_of_the_size_of_a_person() -> None:
    arrays, facts = unpack_arrays(pack_body("male"))
    assert facts["population"] == "male" and arrays["faces"].max() < len(arrays["vertices"])
    height = np.ptp(arrays["vertices"], axis=0).max()
    assert 1.4 < height < 2.1
    assert not np.allclose(arrays["vertices"], unpack_arrays(pack_body("female"))[0]["vertices"])


def test_coefficients_that_are_not_given_are_zero() -> None:
    count = describe_body("neutral").shape_count
    short = pose(BodyFrame(hands={"right": [1.0]}), shape=[0.5])
    padded = pose(BodyFrame(hands={"right": [1.0] + [0.0] * 5}), shape=[0.5] + [0.0] * (count - 1))
    np.testing.assert_allclose(short, padded, atol=1e-6)
    assert not np.allclose(short, pose(BodyFrame(hands={"right": [1.0]})))


def test_a_translation_moves_all_of_the_body_and_a_hand_nothing_but_that_arm() -> None:
    rest, moved, waving = pose(
        BodyFrame(), BodyFrame(translation=[0.1, -0.2, 0.3]), BodyFrame(joints={"left_wrist": [0.0, 0.0, 0.5]})
    )
    np.testing.assert_allclose(moved - rest, np.broadcast_to([0.1, -0.2, 0.3], rest.shape), atol=1e-6)
    changed = np.linalg.norm(waving - rest, axis=1) > 1e-4
    weights = body_model("neutral").skinning_weights
    names = list(body_model("neutral").joint_names)
    arm = [n for n, name in enumerate(names) if name.startswith("left_") and ("wrist" in name or n > 21)]
    arm += [names.index("left_elbow"), names.index("left_shoulder")]
    elsewhere = np.asarray(weights)[:, arm].sum(axis=1) == 0
    assert changed.any() and elsewhere.any() and not (changed & elsewhere).any()


def test_a_joint_that_the_body_has_not_is_named_with_those_it_has() -> None:
    with pytest.raises(InvalidError, match=r"The body has no joint 'horn'; it has \w+, .*left_wrist"):
        pose(BodyFrame(joints={"neck": [0, 0, 0], "tail": [0, 0, 0], "horn": [0, 0, 0]}))


def test_one_mesh_holds_one_pose() -> None:
    asked = BodyExport(format="ply", frames=[BodyFrame(), BodyFrame()])
    with pytest.raises(InvalidError, match="2 poses for one ply; send one, or ask for glb"):
        write_poses("neutral", asked)
    frame = BodyFrame(joints={"neck": [0.0, 0.3, 0.0]})
    written = write_poses("neutral", BodyExport(format="ply", shape=[1.0], frames=[frame]))
    mesh = trimesh.load(io.BytesIO(written), file_type="ply", process=False)
    np.testing.assert_allclose(mesh.vertices, pose(frame, shape=[1.0])[0], atol=1e-5)


def test_a_motion_is_read_to_the_sixth_digit_with_the_person_it_is_of(tmp_path: Path) -> None:
    poses = np.random.default_rng(1).normal(size=(2, 52, 3))
    save_body_motion(BodyMotion(poses, np.full((2, 3), 0.12345678), np.array([0.5]), 25.0, "male"), tmp_path / "a.npz")
    told = read_motion(tmp_path / "a.npz", 2)
    assert (told.population, told.fps, told.shape, len(told.poses)) == ("male", 25.0, [0.5], 2)
    assert told.translations == [[0.123457] * 3] * 2
    np.testing.assert_allclose(np.array(told.poses).reshape(2, 52, 3), poses, atol=5.1e-7)
