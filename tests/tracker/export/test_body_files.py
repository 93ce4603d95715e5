"""A body's files hold the body: meshes vertex for vertex, the animated file by its skin, its morphs and its times."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh
from scipy.sparse import csr_array

from tests.tracker.export.test_gltf_animation import find_moves, pose_skin
from tracker.errors import TrackerError
from tracker.export.body_files import check_shape, pose_frames, write_body_glb, write_meshes, write_obj
from tracker.model.blend_model import BlendModel
from tracker.model.body_model import body_model
from tracker.model.body_motion import BodyMotion
from tracker.model.gltf_container import Gltf, read_gltf

RNG = np.random.default_rng(3)
MOTION = BodyMotion(0.2 * RNG.normal(size=(4, 52, 3)), RNG.normal(size=(4, 3)), RNG.normal(size=20), 60.0)


EVERY = 16


@pytest.fixture(scope="module")
def body() -> BlendModel:
    """Every 16th vertex of the body, each joint at the nearest of them: all that a body has, and quickly exported."""
    whole = body_model("neutral")
    template = whole.template[::EVERY]
    nearest = [int(np.argmin(np.linalg.norm(template - joint, axis=1))) for joint in whole.joints_of(whole.template)]
    joints = np.zeros((whole.num_bones, len(template)))
    joints[np.arange(whole.num_bones), nearest] = 1.0
    return replace(
        whole,
        template=template,
        faces=np.arange(3 * (len(template) // 3), dtype=whole.faces.dtype).reshape(-1, 3),
        shape_directions=np.ascontiguousarray(whole.shape_directions[::EVERY]),
        pose_directions=np.ascontiguousarray(whole.pose_directions[::EVERY]),
        skinning_weights=np.ascontiguousarray(whole.skinning_weights[::EVERY]),
        joint_regressor=csr_array(joints),
        tips=whole.tips // EVERY,
    )


@pytest.fixture(scope="module")
def gltf(body, tmp_path_factory: pytest.TempPathFactory) -> Gltf:
    path = tmp_path_factory.mktemp("glb") / "body.glb"
    path.write_bytes(write_body_glb(body, MOTION, range(1, 4)))
    return read_gltf(path)


def test_the_skin_and_the_morphs_of_the_file_move_as_the_body_does(body, gltf: Gltf) -> None:
    (primitive,) = gltf.document["meshes"][0]["primitives"]
    targets = np.array([gltf.accessor(target["POSITION"], "VEC3") for target in primitive["targets"]])
    (animation,) = gltf.document["animations"]
    (channel,) = (each for each in animation["channels"] if each["target"]["path"] == "weights")
    weights = gltf.accessor(animation["samplers"][channel["sampler"]]["output"], "SCALAR").reshape(-1, len(targets))
    expected = pose_frames(body, MOTION, range(1, 4))
    for row in range(3):
        morphed = np.einsum("k,kvx->vx", weights[row], targets)
        off = np.linalg.norm(
            pose_skin(gltf, gltf.document["nodes"][0], find_moves(gltf, row), morphed) - expected[row], axis=1
        )
        assert np.quantile(off, 0.99) < 2e-4 and off.max() < 2e-3, "m; glTF has four bones a vertex, ten need five"


def test_the_file_counts_time_from_its_first_frame(gltf: Gltf) -> None:
    (animation,) = gltf.document["animations"]
    (times,) = {sampler["input"] for sampler in animation["samplers"]}
    assert np.allclose(gltf.accessor(times, "SCALAR").ravel(), np.arange(3) / 60.0)
    assert gltf.document["scenes"][0]["extras"] == {"fps": 60.0, "first_frame": 1}


def test_frames_are_posed_in_their_order_with_as_much_shape_as_the_body_has(body) -> None:
    found = pose_frames(body, MOTION, range(2, 4))
    for vertices, t in zip(found, (2, 3), strict=True):
        assert np.array_equal(vertices, body.pose_at(MOTION.poses[t], MOTION.shape, MOTION.translations[t]).vertices)
    longer = BodyMotion(MOTION.poses, MOTION.translations, np.append(MOTION.shape, [0.0] * 5))
    assert np.array_equal(pose_frames(body, longer, range(2, 3))[0], found[0])


@pytest.mark.parametrize(("more", "is_refused"), [([], False), ([0.0, 0.0], False), ([0.0, 1e-3], True)])
def test_only_coefficients_that_would_be_lost_are_refused(body, more: list[float], is_refused: bool) -> None:
    motion = BodyMotion(MOTION.poses, MOTION.translations, np.append(MOTION.shape, more))
    if is_refused:
        with pytest.raises(
            TrackerError, match=r"has 22 coefficients, the body has 20\. Cut the motion's 'betas' to 20"
        ):
            check_shape(body, motion)
    else:
        check_shape(body, motion)


def test_an_obj_counts_from_one_and_keeps_a_tenth_of_a_micrometre() -> None:
    vertices = np.array([[0.12345678, -1.0, 2.0], [1e-9, 0.0, 0.0], [3.0, 4.0, 5.0]])
    assert write_obj(vertices, np.array([[0, 2, 1]])) == (
        b"v 0.1234568 -1.0000000 2.0000000\nv 0.0000000 0.0000000 0.0000000\nv 3.0000000 4.0000000 5.0000000\nf 1 3 2\n"
    )


@pytest.mark.parametrize("kind", ["obj", "ply"])
def test_meshes_are_named_by_the_number_of_their_frame_and_told_one_by_one(body, kind: str, tmp_path: Path) -> None:
    told: list[tuple[float, str]] = []
    paths = write_meshes(
        body, MOTION, range(2, 4), tmp_path / "new", kind, lambda share, name: told.append((share, name))
    )
    assert [path.name for path in paths] == [f"000002.{kind}", f"000003.{kind}"]
    assert told == [(0.5, f"000002.{kind}"), (1.0, f"000003.{kind}")]
    mesh = trimesh.load(paths[1], process=False, maintain_order=True)
    assert np.abs(mesh.vertices - pose_frames(body, MOTION, range(3, 4))[0]).max() < 1e-6
    assert np.array_equal(mesh.faces, body.faces)


def test_whoever_is_told_may_end_it_and_whole_meshes_stay(body, tmp_path: Path) -> None:
    def stop(share: float, name: str) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_meshes(body, MOTION, range(4), tmp_path, "ply", stop)
    assert [path.name for path in tmp_path.iterdir()] == ["000000.ply"]
