"""Skinned hands in glTF."""

from __future__ import annotations

import base64
import copy
import json
import os
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tracker.errors import ModelFileError
from tracker.geometry.triangles import is_watertight
from tracker.model import ArticulatedModel, Scene, load_model
from tracker.model.default_hand import default_hand
from tracker.model.joints import FINGERS


def gltf_of(model: ArticulatedModel, uri: str | None = None) -> tuple[dict[str, Any], bytes]:
    """The default hand as somebody else would have written it: y up, in metres, joints in a tree, WebXR's names."""
    tip_points = {f: model.vertices[model.hand.joint_vertices[4 + 4 * k]] for k, f in enumerate(FINGERS)}  # type: ignore[union-attr]
    positions = [*model.skeleton.joints_rest, *tip_points.values()]
    words = {
        "little": "pinky-finger",
        "thumb": "thumb",
        "middle": "middle-finger",
        "index": "index-finger",
        "ring": "ring-finger",
    }
    parts = {
        "metacarpal": "metacarpal",
        "proximal": "phalanx-proximal",
        "middle": "phalanx-intermediate",
        "distal": "phalanx-distal",
    }
    names = ["wrist"]
    for bone in model.skeleton.bone_names[1:]:
        finger, segment = bone.split("_")
        names.append(f"{words[finger]}-{parts[segment]}")
    names += [f"{words[finger]}-tip" for finger in FINGERS]
    parents = [*model.skeleton.parents, *(model.skeleton.bone_names.index(f"{f}_distal") for f in FINGERS)]
    turn = np.array([[0.0, 1, 0], [0, 0, 1], [1, 0, 0]])  # any rotation
    points = np.array(positions) @ turn.T + [0.3, -0.1, 0.2]
    nodes = []
    for name, parent, point in zip(names, parents, points, strict=True):
        base = points[parent] if parent >= 0 else np.zeros(3)
        nodes.append({"name": name, "translation": (point - base).tolist()})
    for index, parent in enumerate(parents):
        if parent >= 0:
            nodes[parent].setdefault("children", []).append(index)
    nodes.append({"name": "hand mesh", "mesh": 0, "skin": 0})
    order = np.argsort(-model.skinning_weights, axis=1, kind="stable")[:, :4]
    inverse = np.tile(np.eye(4, dtype="<f4"), (len(points), 1, 1))
    inverse[:, :3, 3] = -points
    arrays = [
        ("VEC3", (model.vertices @ turn.T + [0.3, -0.1, 0.2]).astype("<f4")),
        ("VEC4", order.astype("<u1")),
        ("VEC4", np.take_along_axis(model.skinning_weights, order, axis=1).astype("<f4")),
        ("SCALAR", model.faces.astype("<u2").reshape(-1, 1)),
        ("MAT4", inverse.transpose(0, 2, 1).reshape(-1, 16)),
    ]
    binary, views, accessors = b"", [], []
    kinds = {"<f4": 5126, "|u1": 5121, "<u2": 5123}
    for form, array in arrays:
        binary += b"\0" * (-len(binary) % 4)
        views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": array.nbytes})
        binary += np.ascontiguousarray(array).tobytes()
        component = kinds[array.dtype.str]
        accessors.append({"bufferView": len(views) - 1, "componentType": component, "count": len(array), "type": form})
    document = {
        "asset": {"version": "2.0"},
        "nodes": nodes,
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "JOINTS_0": 1, "WEIGHTS_0": 2}, "indices": 3}]}],
        "skins": [{"joints": list(range(len(points))), "inverseBindMatrices": 4}],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": len(binary)} | ({} if uri is None else {"uri": uri})],
    }
    return document, binary


DOCUMENT, BINARY = gltf_of(default_hand("right"))


def glb(document: dict[str, Any], binary: bytes) -> bytes:
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(binary), 0x004E4942) + binary
    return struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks


GLB = glb(DOCUMENT, BINARY)


def loaded(
    tmp_path: Path, document: dict[str, Any], binary: bytes = BINARY, name: str = "right_hand.glb"
) -> ArticulatedModel:
    (tmp_path / name).write_bytes(glb(document, binary))
    return load_model(tmp_path / name)


@pytest.mark.parametrize("side", ["right", "left"])
def test_the_default_hand_written_as_glb_comes_back(tmp_path: Path, side: str) -> None:
    model = default_hand(side)
    back = loaded(tmp_path, *gltf_of(model), name=f"{side}.glb")
    assert back.hand is not None and back.hand.side == side and back.num_dofs == 37
    joints, before = (Scene((m,)).pose_at(np.zeros(37)).landmarks(0) for m in (back, model))
    keep = [k for k in range(21) if k not in (4, 8, 12, 16, 20)]
    np.testing.assert_allclose(joints[keep], before[keep], atol=2e-6)
    np.testing.assert_allclose(joints, before, atol=4e-3)
    cosines = np.einsum("kx,kx->k", back.skeleton.dof_axes, model.skeleton.dof_axes)
    assert cosines.min() > np.cos(np.radians(3.0))
    np.testing.assert_allclose(back.skeleton.upper, model.skeleton.upper, atol=np.radians(6.0))
    assert is_watertight(back.faces)


def test_the_side_is_read_off_the_curl_when_no_name_tells_it(tmp_path: Path) -> None:
    for side in ("right", "left"):
        back = loaded(tmp_path, *gltf_of(default_hand(side)), name="somebody.glb")
        assert back.hand is not None and back.hand.side == side


@pytest.mark.shared_data
@pytest.mark.parametrize("side", ["right", "left"])
def test_the_hands_of_webxr_have_31_revolute_joints(shared_data: Path, side: str) -> None:
    model = load_model(shared_data / "webxr_hand" / f"xr_{side}.glb")
    assert model.hand is not None and model.hand.side == side
    assert model.num_dofs == 37 and model.skeleton.num_bones == 20
    assert len(model.faces) <= 1530 and is_watertight(model.faces)
    assert all(len(ids) >= 8 for ids in model.hand.fingertips)
    assert np.all(model.skeleton.lower < 0.0) and np.all(model.skeleton.upper > 0.0)
    rest = Scene((model,)).pose_at(np.zeros(37)).landmarks(0)
    for number in range(1, 5):
        tip = 4 + 4 * number
        place = 6 + next(
            k
            for k, b in enumerate(model.skeleton.dof_bones)
            if model.skeleton.bone_names[b] == f"{FINGERS[number]}_middle"
        )
        pose = np.zeros(37)
        pose[place] = 1.0
        assert (Scene((model,)).pose_at(pose).landmarks(0)[tip] - rest[tip])[2] < -0.01


def test_buffers_beside_the_file_and_in_data_uris_are_read(tmp_path: Path) -> None:
    document, binary = gltf_of(default_hand("right"), uri="my%20hand.bin")
    (tmp_path / "my hand.bin").write_bytes(binary)
    (tmp_path / "right.gltf").write_text(json.dumps(document))
    inside = copy.deepcopy(document)
    inside["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(binary).decode()
    (tmp_path / "right_inside.gltf").write_text(json.dumps(inside))
    one, other = load_model(tmp_path / "right.gltf"), load_model(tmp_path / "right_inside.gltf")
    np.testing.assert_array_equal(one.vertices, other.vertices)


@pytest.mark.parametrize(
    "uri",
    [
        "../secret.bin",
        "%2e%2e/secret.bin",
        "link.bin",
        "/etc/hostname",
        "file:///etc/hostname",
        "https://example.org/hand.bin",
        "..\\secret.bin",
        "C:secret.bin",
        "missing.bin",
        "data:text/plain,abc",
        "data:;base64,***",
        7,
        None,
    ],
)
def test_a_buffer_outside_the_folder_is_never_opened(tmp_path: Path, uri: Any) -> None:
    folder = tmp_path / "models"
    folder.mkdir()
    (tmp_path / "secret.bin").write_bytes(BINARY)
    os.symlink(tmp_path / "secret.bin", folder / "link.bin")
    document = copy.deepcopy(DOCUMENT)
    document["buffers"][0]["uri"] = uri
    (folder / "right.gltf").write_text(json.dumps(document))
    with pytest.raises(ModelFileError):
        load_model(folder / "right.gltf")


def edit(path: str, value: Any) -> dict[str, Any]:
    document = copy.deepcopy(DOCUMENT)
    *way, last = [int(step) if step.isdigit() else step for step in path.split("/")]
    place: Any = document
    for step in way:
        place = place[step]
    place[last] = value
    return document


BAD_VALUES = [
    ("asset/version", "1.0"),
    ("asset", None),
    ("nodes", 3),
    ("nodes/0", "wrist"),
    ("nodes/0/children", [0]),
    ("nodes/1/children", [0, 2]),
    ("nodes/0/translation", [1, 2]),
    ("nodes/0/translation", ["a", 0, 0]),
    ("nodes/0/rotation", [0, 0, 0, 0]),
    ("nodes/0/matrix", [1]),
    ("nodes/0/name", "elbow"),
    ("nodes/3/name", {"a": 1}),
    ("nodes/25/skin", 9),
    ("nodes/25/mesh", "x"),
    ("skins/0/joints", []),
    ("skins/0/joints", [99]),
    ("skins/0/joints", [True] * 25),
    ("skins/0/inverseBindMatrices", 2),
    ("meshes/0/primitives", []),
    ("meshes/0/primitives/0/mode", 1),
    ("meshes/0/primitives/0/attributes", {"POSITION": 0}),
    ("meshes/0/primitives/0/attributes/WEIGHTS_0", 0),
    ("meshes/0/primitives/0/indices", 0),
    ("accessors/0/count", 10**12),
    ("accessors/0/count", 0),
    ("accessors/0/count", -5),
    ("accessors/0/byteOffset", 10**9),
    ("accessors/0/byteOffset", -4),
    ("accessors/0/type", "VEC9"),
    ("accessors/0/componentType", [5126]),
    ("accessors/0/sparse", {}),
    ("accessors/3/count", 4),
    ("bufferViews/0/byteStride", 1),
    ("bufferViews/0/byteStride", -12),
    ("bufferViews/0/byteStride", 2**50),
    ("bufferViews/0/buffer", 5),
    ("bufferViews/0/byteLength", 12.5),
    ("buffers", "none"),
    ("extensionsRequired", ["KHR_draco_mesh_compression"]),
]


@pytest.mark.parametrize(("path", "value"), BAD_VALUES)
def test_a_file_with_a_wrong_value_is_refused(tmp_path: Path, path: str, value: Any) -> None:
    with pytest.raises(ModelFileError) as caught:
        loaded(tmp_path, edit(path, value))
    assert caught.value.found and caught.value.needed


def test_a_skin_whose_joints_cannot_be_told_is_refused_with_the_joints_that_are_missing(tmp_path: Path) -> None:
    document = copy.deepcopy(DOCUMENT)
    for node in document["nodes"]:
        node["name"] = "bone"
    with pytest.raises(ModelFileError, match="wrist, thumb metacarpal"):
        loaded(tmp_path, document)


def test_a_hand_in_centimetres_is_refused_with_its_length(tmp_path: Path) -> None:
    document = copy.deepcopy(DOCUMENT)
    for node in document["nodes"]:
        if "translation" in node:
            node["translation"] = [100.0 * value for value in node["translation"]]
    with pytest.raises(ModelFileError, match=r"18\.\d+ m long"):
        loaded(tmp_path, document)


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(cut=st.integers(0, len(GLB) - 1))
def test_a_truncated_file_is_refused(tmp_path: Path, cut: int) -> None:
    (tmp_path / "right.glb").write_bytes(GLB[:cut])
    with pytest.raises(ModelFileError):
        load_model(tmp_path / "right.glb")


@settings(max_examples=100, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(changes=st.lists(st.tuples(st.integers(0, len(GLB) - 1), st.integers(0, 255)), min_size=1, max_size=30))
def test_a_garbled_file_gives_a_model_or_a_model_file_error(tmp_path: Path, changes: list[tuple[int, int]]) -> None:
    data = bytearray(GLB)
    for place, value in changes:
        data[place] = value
    (tmp_path / "right.glb").write_bytes(bytes(data))
    try:
        model = load_model(tmp_path / "right.glb", max_faces=None)
    except ModelFileError:
        return
    assert np.all(np.isfinite(model.vertices)) and np.all(np.isfinite(model.skeleton.dof_axes))


JSON_LEAVES = st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5)
JSON_VALUES = st.recursive(
    JSON_LEAVES, lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=3), inner, max_size=3)
)


@settings(max_examples=200, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    path=st.sampled_from([path for path, _ in BAD_VALUES] + ["skins", "meshes/0", "accessors", "nodes/5"]),
    value=JSON_VALUES,
)
def test_any_value_anywhere_gives_a_model_or_a_model_file_error(tmp_path: Path, path: str, value: Any) -> None:
    try:
        loaded(tmp_path, edit(path, value))
    except ModelFileError:
        return
