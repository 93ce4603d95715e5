"""Meshes of every kind become the same rigid object; bad ones are refused with the facts."""

from __future__ import annotations

import json
import logging
import struct
from pathlib import Path

import numpy as np
import pytest
import trimesh
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tracker.errors import ModelFileError
from tracker.geometry import se3
from tracker.geometry.triangles import is_watertight
from tracker.model import Scene, load_model, save_model
from tracker.model.decimation import compute_volume
from tracker.model.object_files import load_object

KINDS = ["obj", "ply", "stl", "off", "glb", "gltf"]
OFFSET = np.array([0.3, -0.1, 0.05])


def box(scale: float = 1.0) -> trimesh.Trimesh:
    """A box of 60 x 40 x 20 mm that does not stand at the origin, in metres times `scale`."""
    mesh = trimesh.creation.box(extents=[0.06, 0.04, 0.02])
    mesh.apply_translation(OFFSET)
    mesh.apply_scale(scale)
    return mesh


def write(folder: Path, kind: str, mesh: trimesh.Trimesh) -> Path:
    path = folder / f"thing.{kind}"
    if kind == "gltf":
        for name, data in trimesh.exchange.gltf.export_gltf(trimesh.Scene(mesh)).items():
            (folder / name.replace("model.gltf", path.name)).write_bytes(data)
    else:
        mesh.export(path)
    return path


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_gives_the_same_rigid_object_in_the_coordinates_of_its_file(tmp_path: Path, kind: str) -> None:
    model = load_model(write(tmp_path, kind, box()))
    assert model.hand is None and model.num_dofs == 6 and len(model.vertices) == 8 and len(model.faces) == 12
    assert is_watertight(model.faces) and model.provenance["holes"] == "none"
    assert compute_volume(model.vertices, model.faces) == pytest.approx(0.06 * 0.04 * 0.02, rel=1e-5)
    np.testing.assert_allclose(np.sort(model.vertices[:, 0])[[0, -1]], OFFSET[0] + [-0.03, 0.03], atol=1e-7)
    np.testing.assert_allclose(model.skeleton.joints_rest, [OFFSET], atol=1e-7)


def test_the_pose_takes_the_coordinates_of_the_file_to_the_world(tmp_path: Path, rng: np.random.Generator) -> None:
    model = load_model(write(tmp_path, "ply", box()))
    scene = Scene((model,))
    T = se3.exp(rng.normal(size=6))
    posed = scene.pose_at(se3.log(T))
    np.testing.assert_allclose(posed.T_world_model(0), T, atol=1e-9)
    np.testing.assert_allclose(posed.vertices[:8], se3.transform(T, model.vertices), atol=1e-9)


@pytest.mark.parametrize(("scale", "name"), [(1.0, "metres"), (100.0, "centimetres"), (1000.0, "millimetres")])
def test_the_unit_is_guessed_from_the_size_and_told(tmp_path: Path, scale: float, name: str, caplog) -> None:
    path = write(tmp_path, "stl", box(scale))
    with caplog.at_level(logging.INFO):
        model = load_model(path)
    assert np.ptp(model.vertices[:, 0]) == pytest.approx(0.06, rel=1e-5)
    assert model.provenance["unit"].startswith(f"{name}, guessed") and "74.83 mm" in model.provenance["unit"]
    assert name in caplog.text


def test_the_unit_can_be_given_and_is_checked(tmp_path: Path) -> None:
    path = write(tmp_path, "obj", box(1000.0 / 25.4))
    assert np.ptp(load_model(path, metres_per_unit=0.0254).vertices[:, 0]) == pytest.approx(0.06, rel=1e-5)
    for unit in (0.0, -1.0, float("nan"), 1e6, 1e-9):
        with pytest.raises(ModelFileError):
            load_model(path, metres_per_unit=unit)


@pytest.mark.parametrize("scale", [1e-4, 1e6])
def test_a_size_that_no_unit_explains_is_refused(tmp_path: Path, scale: float) -> None:
    with pytest.raises(ModelFileError, match="metres per unit"):
        load_model(write(tmp_path, "obj", box(scale)))


def test_a_heavy_mesh_is_decimated_and_stays_in_place(tmp_path: Path) -> None:
    heavy = trimesh.creation.icosphere(subdivisions=5, radius=21.0)
    model = load_model(write(tmp_path, "ply", heavy))
    assert len(model.faces) <= 1530 and is_watertight(model.faces)
    np.testing.assert_allclose(np.linalg.norm(model.vertices, axis=1), 0.021, atol=3e-4)
    assert len(load_model(tmp_path / "thing.ply", max_faces=None).faces) == len(heavy.faces)


def test_a_mesh_with_holes_is_taken_with_a_warning(tmp_path: Path, caplog) -> None:
    mesh = box()
    mesh.update_faces(np.arange(len(mesh.faces)) > 1)
    with caplog.at_level(logging.WARNING):
        model = load_model(write(tmp_path, "obj", mesh))
    assert len(model.faces) == 10 and "edges" in model.provenance["holes"] and "holes" in caplog.text
    assert compute_volume(model.vertices - model.vertices.mean(axis=0), model.faces) > 0.0


@pytest.mark.parametrize("seed", range(3))
def test_faces_that_look_anywhere_are_turned_outwards(tmp_path: Path, seed: int) -> None:
    mesh = trimesh.util.concatenate([box(), trimesh.creation.icosphere(subdivisions=1, radius=0.03)])
    flip = np.random.default_rng(seed).random(len(mesh.faces)) < (0.5 if seed else 1.0)
    faces = np.where(flip[:, None], mesh.faces[:, ::-1], mesh.faces)
    model = load_model(write(tmp_path, "obj", trimesh.Trimesh(mesh.vertices, faces, process=False)))
    assert is_watertight(model.faces)
    assert compute_volume(model.vertices, model.faces) == pytest.approx(mesh.volume, rel=1e-4)


def test_a_heap_of_loose_triangles_takes_no_time(tmp_path: Path, rng: np.random.Generator) -> None:
    corners = rng.uniform(-0.1, 0.1, size=(20_000, 1, 3)) + rng.normal(scale=1e-3, size=(20_000, 3, 3))
    soup = trimesh.Trimesh(corners.reshape(-1, 3), np.arange(60_000).reshape(-1, 3), process=False)
    model = load_model(write(tmp_path, "stl", soup), max_faces=None)
    assert len(model.faces) == 20_000


def test_an_object_goes_through_our_own_file_to_the_bit(tmp_path: Path) -> None:
    model = load_model(write(tmp_path, "stl", box()))
    save_model(model, tmp_path / "thing.npz")
    again = load_model(tmp_path / "thing.npz")
    np.testing.assert_array_equal(again.vertices, model.vertices)
    assert again.num_dofs == 6 and again.provenance == model.provenance


def test_nodes_of_a_gltf_place_their_meshes(tmp_path: Path) -> None:
    scene = trimesh.Scene()
    T = np.eye(4)
    T[:3, 3] = [0.0, 0.2, 0.0]
    scene.add_geometry(box(), transform=T)
    scene.add_geometry(trimesh.creation.icosphere(subdivisions=1, radius=0.02))
    scene.export(tmp_path / "two.glb")
    model = load_model(tmp_path / "two.glb")
    assert model.vertices[:, 1].max() == pytest.approx(0.2 - 0.1 + 0.02, abs=1e-6)
    assert model.vertices[:, 1].min() == pytest.approx(-0.02, abs=1e-3)


def test_files_that_an_obj_names_are_not_opened(tmp_path: Path) -> None:
    path = write(tmp_path, "obj", box())
    path.write_text("mtllib ../../../../etc/passwd\n" + path.read_text())
    assert load_model(path).num_dofs == 6


def ply(vertices: int, faces: int) -> bytes:
    head = f"ply\nformat binary_little_endian 1.0\nelement vertex {vertices}\n"
    head += "property float x\nproperty float y\nproperty float z\n"
    head += f"element face {faces}\nproperty list uchar int vertex_indices\nend_header\n"
    return head.encode()


GLTF = {"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {}}]}]}

HOSTILE = {
    "empty.obj": b"",
    "points.obj": b"v 0 0 0\nv 1 0 0\nv 0 1 0\n",
    "index.obj": b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 999999999\n",
    "nan.obj": b"v nan 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 2 3\nf 2 3 4\n",
    "flat.obj": b"v 0 0 0\nv 0.1 0 0\nv 0.2 0 0\nf 1 2 3\n",
    "words.obj": b"v a b c\nf x y z\n",
    "huge.ply": ply(1_000_000_000, 1_000_000_000),
    "negative.ply": ply(-5, -5),
    "cloud.ply": ply(1, 0).replace(b"binary_little_endian", b"ascii") + b"0 0 0\n",
    "count.stl": b"\0" * 80 + struct.pack("<I", 4_000_000_000) + b"\0" * 100,
    "solid.stl": b"solid nothing\nendsolid nothing\n",
    "loop.gltf": json.dumps(GLTF | {"nodes": [{"mesh": 0, "children": [0]}]}).encode(),
    "bare.gltf": json.dumps(GLTF).encode(),
    "none.gltf": json.dumps(GLTF | {"nodes": []}).encode(),
    "nodes.gltf": json.dumps(GLTF | {"nodes": "many"}).encode(),
    "head.off": b"OFF\n999999999 1 0\n",
    "short.glb": b"glTF\x02\0\0\0",
}


@pytest.mark.parametrize("name", HOSTILE)
def test_hostile_files_are_refused_with_the_facts(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_bytes(HOSTILE[name])
    with pytest.raises(ModelFileError) as caught:
        load_model(tmp_path / name)
    assert caught.value.found and caught.value.needed and name in str(caught.value)


@settings(max_examples=80, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    kind=st.sampled_from(["obj", "ply", "stl", "off", "glb"]),
    changes=st.lists(st.tuples(st.integers(0, 2000), st.integers(0, 255)), max_size=6),
    cut=st.integers(0, 2000),
)
def test_garbled_and_truncated_files_give_an_object_or_a_model_file_error(
    tmp_path: Path, kind: str, changes: list[tuple[int, int]], cut: int
) -> None:
    path = write(tmp_path, kind, box())
    data = bytearray(path.read_bytes())
    for place, value in changes:
        data[place % len(data)] = value
    path.write_bytes(bytes(data)[: cut + len(data) // 4])
    try:
        model = load_object(path)
    except ModelFileError:
        return
    assert np.all(np.isfinite(model.vertices)) and len(model.faces) >= 2


@pytest.mark.shared_data
@pytest.mark.parametrize(("name", "dofs"), [("Ball", 6), ("Cube", 6), ("Pipe_Gray", 7), ("Pipe_Green_Long", 76)])
def test_the_objects_of_t16_have_their_degrees_of_freedom(shared_data: Path, name: str, dofs: int) -> None:
    model = load_model(shared_data / "ijcv16" / "models" / f"Model_Object_{name}.OFF")
    assert model.num_dofs == dofs and model.hand is None and len(model.faces) <= 1530
