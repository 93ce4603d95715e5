"""The body with hands: what is asked for is what the model gives, in every file."""

from __future__ import annotations

import io
import json
import struct

import numpy as np
import pytest
import trimesh
from fastapi.testclient import TestClient

from server.bodies.service import read_motion
from server.errors import InvalidError
from tests.server.packed_arrays import unpack_arrays
from tracker.errors import TrackerError
from tracker.model.body_hands import body_pose
from tracker.model.body_model import body_model
from tracker.model.body_motion import BodyMotion, save_body_motion
from tracker.model.mano_files import load_mano

NEUTRAL = "/api/v1/body-models/neutral"


def send_motion(client: TestClient, data: bytes, name: str = "walk.npz"):
    return client.post("/api/v1/body-models/motions", files={"files": (name, data)})


@pytest.mark.parametrize("population", ["neutral", "male", "female"])
def test_the_body_of_each_population_is_described_and_its_mesh_is_the_mean_person(client, population):
    told = client.get(f"/api/v1/body-models/{population}").json()
    model = body_model(population)
    assert told["joints"] == list(model.joint_names) and told["parents"] == model.parents.tolist()
    assert (told["vertices"], told["shape_count"], told["hand_component_count"]) == (6683, 20, 45)
    arrays, _ = unpack_arrays(client.get(f"/api/v1/body-models/{population}/geometry").content)
    np.testing.assert_allclose(arrays["vertices"], model.template, atol=1e-6)
    np.testing.assert_array_equal(arrays["faces"], model.faces)


def test_a_pose_by_joints_and_hands_and_the_same_by_156_numbers_are_one(client, rng):
    model, shape = body_model("neutral"), rng.normal(size=20)
    hands = {side: rng.normal(size=6) for side in ("left", "right")}
    pose = body_pose(model, np.zeros(3), np.zeros((21, 3)), hands)
    pose[18] = [0.0, 0.4, 0.0]
    by_joints = {"joints": {"left_elbow": [0.0, 0.4, 0.0]}, "hands": {side: h.tolist() for side, h in hands.items()}}
    whole = {"pose": pose.reshape(-1).tolist(), "translation": [0.5, 0.0, -0.2]}
    answer = client.post(f"{NEUTRAL}/poses", json={"shape": shape.tolist(), "frames": [by_joints, whole]})
    arrays, _ = unpack_arrays(answer.content)
    np.testing.assert_allclose(arrays["vertices"][0], model.pose_at(pose, shape).vertices, atol=1e-6)
    np.testing.assert_allclose(arrays["vertices"][1], arrays["vertices"][0] + [0.5, 0.0, -0.2], atol=1e-5)


def test_a_motion_file_comes_back_as_it_is(client, rng, tmp_path):
    motion = BodyMotion(rng.normal(size=(7, 52, 3)), rng.normal(size=(7, 3)), rng.normal(size=4), 60.0, "female")
    save_body_motion(motion, tmp_path / "walk.npz")
    told = send_motion(client, (tmp_path / "walk.npz").read_bytes()).json()
    assert (told["population"], told["fps"]) == ("female", 60.0)
    np.testing.assert_allclose(np.array(told["poses"]).reshape(7, 52, 3), motion.poses, atol=1e-6)
    np.testing.assert_allclose(told["translations"], motion.translations, atol=1e-6)
    np.testing.assert_allclose(told["shape"], motion.shape)


@pytest.mark.parametrize("kind", ["obj", "ply"])
def test_a_pose_is_written_as_the_mesh_that_is_shown(client, kind):
    asked = {"shape": [1.0], "frames": [{"hands": {"right": [1.0, -1.0]}}]}
    shown, _ = unpack_arrays(client.post(f"{NEUTRAL}/poses", json=asked).content)
    written = client.post(f"{NEUTRAL}/export", json={**asked, "format": kind})
    mesh = trimesh.load(io.BytesIO(written.content), file_type=kind, process=False)
    np.testing.assert_allclose(mesh.vertices, shown["vertices"][0], atol=1e-5)


def test_a_motion_is_written_as_an_animated_gltf(client):
    frames = [{"joints": {"neck": [0.0, 0.1 * t, 0.0]}} for t in range(5)]
    written = client.post(f"{NEUTRAL}/export", json={"format": "glb", "frames": frames, "fps": 10.0})
    assert written.content[:4] == b"glTF" and 'filename="neutral_body.glb"' in written.headers["content-disposition"]
    (length,) = struct.unpack("<I", written.content[12:16])
    document = json.loads(written.content[20 : 20 + length])
    times = {sampler["input"] for animation in document["animations"] for sampler in animation["samplers"]}
    ends = [document["accessors"][number]["max"][0] for number in times]
    assert ends and ends == pytest.approx([0.4] * len(ends)), "five frames at 10 a second"


@pytest.mark.parametrize("kind", ["npz", "pkl"])
def test_the_file_for_smplx_is_the_model(client, tmp_path, kind):
    path = tmp_path / f"SMPLH.{kind}"
    path.write_bytes(client.get(f"/api/v1/body-models/male/smplh.{kind}").content)
    np.testing.assert_allclose(load_mano(path).template, body_model("male").template, atol=1e-9)


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        ({"frames": [{"joints": {"tail": [0, 0, 0]}}]}, "no joint 'tail'"),
        ({"shape": [0.0] * 21, "frames": [{}]}, "21 coefficients of the shape; the body has 20"),
        ({"frames": [{"pose": [0.0] * 156, "joints": {"neck": [0, 0, 0]}}]}, "leave `joints` and `hands` out"),
        ({"frames": []}, "frames"),
        ({"frames": [{"pose": [0.0] * 155}]}, "pose"),
        ({"frames": [{}] * 65}, "frames"),
    ],
)
def test_poses_that_cannot_be_are_refused_with_what_is_wrong(client, asked, said):
    answer = client.post(f"{NEUTRAL}/poses", json=asked)
    assert answer.status_code == 422 and said in answer.text


def test_two_poses_are_no_obj_and_a_population_that_is_none_is_refused(client):
    assert client.post(f"{NEUTRAL}/export", json={"format": "obj", "frames": [{}, {}]}).status_code == 422
    assert client.get("/api/v1/body-models/children").status_code == 422


@pytest.mark.parametrize("data", [b"", b"PK\x03\x04broken", b"\x80\x04."], ids=["empty", "cut off", "a pickle"])
def test_a_file_that_is_no_motion_is_refused_with_its_name(client, data):
    answer = send_motion(client, data, "evil.npz")
    assert answer.status_code == 422 and answer.json()["detail"].startswith("evil.npz: ")
    assert "needed an .npz archive" in answer.json()["detail"]


def test_a_motion_longer_than_the_page_plays_is_refused_with_both_numbers(tmp_path):
    motion = BodyMotion(np.zeros((5, 52, 3)), np.zeros((5, 3)), np.zeros(0), 30.0)
    save_body_motion(motion, tmp_path / "long.npz")
    with pytest.raises(InvalidError, match=r"long\.npz has 5 frames; the page plays 4 at most"):
        read_motion(tmp_path / "long.npz", 4)
    assert len(read_motion(tmp_path / "long.npz", 5).poses) == 5


def test_a_motion_of_a_person_with_more_directions_than_the_body_has_keeps_only_those_that_say_nothing(tmp_path):
    for shape, is_kept in ((np.r_[np.ones(20), np.zeros(5)], True), (np.ones(25), False)):
        save_body_motion(BodyMotion(np.zeros((1, 52, 3)), np.zeros((1, 3)), shape, 30.0), tmp_path / "walk.npz")
        if is_kept:
            assert read_motion(tmp_path / "walk.npz", 5).shape == [1.0] * 20
        else:
            with pytest.raises(TrackerError, match="shape"):
                read_motion(tmp_path / "walk.npz", 5)
