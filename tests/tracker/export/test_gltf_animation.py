"""The file is read back by others and by us, and its skin moves as our meshes do."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation

from tests.tracker.export.conftest import make_moved
from tracker.export.gltf_animation import T_GLTF_WORLD, write_glb
from tracker.geometry import se3
from tracker.model.blend_articulated import articulated_of
from tracker.model.default_hand import default_hand
from tracker.model.gltf_container import Gltf, read_gltf
from tracker.model.gltf_files import load_gltf_model
from tracker.model.trained_hand import trained_hand


@pytest.fixture(scope="module")
def path(moved, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("glb") / "track.glb"
    path.write_bytes(write_glb(moved.track, moved.sequence.fps))
    return path


def node_matrix(node: dict[str, Any], moves: dict[str, np.ndarray]) -> np.ndarray:
    T = np.eye(4)
    T[:3, :3] = Rotation.from_quat(moves.get("rotation", node.get("rotation", [0, 0, 0, 1]))).as_matrix()
    T[:3, 3] = moves.get("translation", node.get("translation", [0, 0, 0]))
    return T


def find_moves(gltf: Gltf, key: int) -> dict[int, dict[str, np.ndarray]]:
    """What the animation says of each node at one of its times."""
    (animation,) = gltf.document["animations"]
    moves: dict[int, dict[str, np.ndarray]] = {}
    for channel in animation["channels"]:
        sampler, target = animation["samplers"][channel["sampler"]], channel["target"]
        if target["path"] == "weights":
            continue
        form = "VEC4" if target["path"] == "rotation" else "VEC3"
        moves.setdefault(target["node"], {})[target["path"]] = gltf.accessor(sampler["output"], form)[key]
    return moves


def pose_skin(
    gltf: Gltf, mesh_node: dict[str, Any], moves: dict[int, dict[str, np.ndarray]], morphed: np.ndarray | float = 0.0
) -> np.ndarray:
    """(V, 3) a skinned mesh as the glTF specification poses it, world of the file, m."""
    nodes = gltf.document["nodes"]
    Ts: dict[int, np.ndarray] = {}

    def visit(index: int, T_world_parent: np.ndarray) -> None:
        Ts[index] = T_world_parent @ node_matrix(nodes[index], moves.get(index, {}))
        for child in nodes[index].get("children", []):
            visit(child, Ts[index])

    for root in gltf.document["scenes"][0]["nodes"]:
        visit(root, np.eye(4))
    skin = gltf.document["skins"][mesh_node["skin"]]
    inverse = gltf.accessor(skin["inverseBindMatrices"], "MAT4").reshape(-1, 4, 4).transpose(0, 2, 1)
    moved = np.stack([Ts[joint] for joint in skin["joints"]]) @ inverse
    (primitive,) = gltf.document["meshes"][mesh_node["mesh"]]["primitives"]
    points, joints, weights = (
        gltf.accessor(primitive["attributes"][name], form)
        for name, form in (("POSITION", "VEC3"), ("JOINTS_0", "VEC4"), ("WEIGHTS_0", "VEC4"))
    )
    homogeneous = np.c_[points + morphed, np.ones(len(points))]
    return np.einsum("vw,vwij,vj->vi", weights, moved[joints][:, :, :3], homogeneous)


def test_the_skin_of_the_file_moves_as_our_meshes_do(moved, path: Path):
    gltf, track = read_gltf(path), moved.track
    scene = track.setup.scene
    mesh_nodes = [node for node in gltf.document["nodes"] if "mesh" in node]
    assert [node["name"] for node in mesh_nodes] == ["right mesh", "left mesh", "rope mesh", "ball mesh"]
    for row, pose in enumerate(track.pose):
        expected, moves = se3.transform(T_GLTF_WORLD, scene.pose_at(pose).vertices), find_moves(gltf, row)
        for node, where in zip(mesh_nodes, scene.vertex_slices, strict=True):
            assert np.abs(pose_skin(gltf, node, moves) - expected[where]).max() < 1e-5  # m


def test_a_trained_hand_moves_in_the_file_with_what_its_pose_does_to_its_surface(tmp_path: Path):
    one = make_moved({"right": articulated_of(trained_hand("right"))})
    (tmp_path / "track.glb").write_bytes(write_glb(one.track, 30.0))
    gltf, scene = read_gltf(tmp_path / "track.glb"), one.track.setup.scene
    (node,) = (node for node in gltf.document["nodes"] if "mesh" in node)
    (primitive,) = gltf.document["meshes"][0]["primitives"]
    targets = np.array([gltf.accessor(target["POSITION"], "VEC3") for target in primitive["targets"]])
    (animation,) = gltf.document["animations"]
    (channel,) = (each for each in animation["channels"] if each["target"]["path"] == "weights")
    assert gltf.document["nodes"][channel["target"]["node"]] == node
    weights = gltf.accessor(animation["samplers"][channel["sampler"]]["output"], "SCALAR").reshape(-1, len(targets))
    plain = 0.0
    for row, pose in enumerate(one.track.pose):
        expected = se3.transform(T_GLTF_WORLD, scene.pose_at(pose).vertices[: targets.shape[1]])
        moves = find_moves(gltf, row)
        morphed = np.einsum("k,kvx->vx", weights[row], targets)
        assert np.linalg.norm(pose_skin(gltf, node, moves, morphed) - expected, axis=1).max() < 2e-4  # m
        plain = max(plain, np.linalg.norm(pose_skin(gltf, node, moves) - expected, axis=1).max())
    assert plain > 1e-3, "skinning alone would be off by millimetres"


def test_times_are_those_of_the_recording_from_the_first_frame_on(moved, path: Path):
    gltf = read_gltf(path)
    (animation,) = gltf.document["animations"]
    (times,) = {sampler["input"] for sampler in animation["samplers"]}
    assert np.allclose(gltf.accessor(times, "SCALAR").ravel(), np.arange(6) / 25.0)
    extras = gltf.document["scenes"][0]["extras"]
    assert (extras["first_frame"], extras["fps"], extras["status"][2]) == (3, 25.0, "lost")


def test_no_bone_turns_the_long_way_round_between_two_frames(path: Path):
    gltf = read_gltf(path)
    (animation,) = gltf.document["animations"]
    for channel in animation["channels"]:
        if channel["target"]["path"] == "rotation":
            xyzw = gltf.accessor(animation["samplers"][channel["sampler"]]["output"], "VEC4").astype(np.float64)
            assert np.abs(np.linalg.norm(xyzw, axis=1) - 1.0).max() < 1e-6
            assert np.sum(xyzw[1:] * xyzw[:-1], axis=1).min() >= 0.0


def test_only_roots_are_shifted_since_bones_turn_about_their_joints(path: Path):
    gltf = read_gltf(path)
    shifted = [
        c["target"]["node"] for c in gltf.document["animations"][0]["channels"] if c["target"]["path"] != "rotation"
    ]
    assert [gltf.document["nodes"][node]["name"] for node in shifted] == [
        "right/wrist", "left/wrist", "rope/bone_0", "ball/bone_0",
    ]  # fmt: skip


def test_trimesh_reads_every_mesh_with_its_vertices_and_faces(moved, path: Path):
    read = trimesh.load_scene(path, process=False)
    assert set(read.geometry) == {"right", "left", "rope", "ball"}
    for name, model in zip(moved.track.setup.names, moved.track.setup.models, strict=True):
        mesh = read.geometry[name]
        assert np.abs(mesh.vertices - model.vertices).max() < 1e-6
        assert np.array_equal(mesh.faces, model.faces)


def test_up_in_the_picture_is_up_in_the_file():
    assert np.allclose(T_GLTF_WORLD @ [0.0, -1.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0])
    assert np.linalg.det(T_GLTF_WORLD) == 1.0


def test_an_exported_hand_is_a_hand_model_again(tmp_path: Path):
    hand = default_hand("left")
    one = make_moved({"left": hand})
    (tmp_path / "track.glb").write_bytes(write_glb(one.track, 30.0))
    model = load_gltf_model(tmp_path / "track.glb", max_faces=None)
    assert model.hand is not None and model.hand.side == "left"
    assert model.skeleton.bone_names == hand.skeleton.bone_names
    assert np.abs(model.skeleton.joints_rest - hand.skeleton.joints_rest).max() < 1e-5  # m
