"""Whatever comes in, a run ends with a clear error or with frames called lost: no crash, no silent wrong pose.

Everything goes through `handloom track`, as people call it.
"""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import cast

import cv2
import numpy as np
import pytest
import trimesh

from tracker.capture.camera import Camera
from tracker.cli.__main__ import main
from tracker.geometry import se3
from tracker.model.default_hand import default_hand
from tracker.model.npz_files import save_npz_model
from tracker.model.object_files import load_object
from tracker.rendering.zbuffer import render_depth
from tracker.synthesis.actor import Actor
from tracker.synthesis.motion import perform
from tracker.synthesis.performance import Performance
from tracker.synthesis.recording import RecordingOptions, write_recording

BAD_INPUT = 2


@pytest.fixture
def recording(recorded, tmp_path) -> Path:
    """A copy of the rendered recording, cut to four frames, to be spoilt."""
    folder = tmp_path / "recording"
    shutil.copytree(recorded.sequence.folder, folder)
    change(folder, lambda document: document.update(frame_count=4))
    return folder


def change(folder: Path, spoil) -> None:
    path = folder / "sequence.json"
    document = json.loads(path.read_text())
    spoil(document)
    path.write_text(json.dumps(document))


def track(recording: Path, *options: str) -> int:
    return main(["track", str(recording), "--out", str(recording.parent / "track"), *options])


def statuses(recording: Path) -> list[str]:
    with np.load(recording.parent / "track" / "track.npz") as arrays:
        assert np.isfinite(arrays["joints_3d"]).all()
        assert np.isfinite(arrays["pose"]).all()
        return [str(status) for status in arrays["status"]]


def write_depths(recording: Path, depths_mm: dict[int, np.ndarray]) -> None:
    for index, depth in depths_mm.items():
        path = sorted((recording / "depth").rglob("*.png") if (recording / "depth").is_dir() else [])
        paths = path or sorted(p for p in recording.rglob("*.png") if "depth" in str(p.relative_to(recording)))
        cv2.imwrite(str(paths[index]), depth.astype(np.uint16))


def refusal(capsys) -> str:
    captured = capsys.readouterr()
    assert captured.out == ""
    assert "Traceback" not in captured.err
    return captured.err


def test_a_recording_without_depth_needs_the_hand_detector(recording, capsys):
    change(recording, lambda document: document["cameras"][0].pop("depth"))
    assert track(recording, "--no-detector") == BAD_INPUT
    assert "In colour images only the hand detector finds hands" in refusal(capsys)


@pytest.mark.parametrize(
    ("cameras", "said"),
    [
        ("cam0,cam7", "cam7 is no camera with colour images of this recording. Choose among cam0."),
        ("cam0,cam0", "chosen twice (cam0,cam0)"),
        (",".join(f"cam{number}" for number in range(17)), "are no cameras with colour images"),
    ],
)
def test_colour_cameras_that_cannot_be_tracked_in_are_named(recording, capsys, cameras, said):
    assert track(recording, "--cameras", cameras) == BAD_INPUT
    assert said in refusal(capsys)


def test_a_missing_depth_image_is_named(recording, capsys):
    (paths := sorted(p for p in recording.rglob("*.png") if "depth" in str(p.relative_to(recording))))[2].unlink()
    assert track(recording, "--no-calibration", "--annotations", str(recording / "annotations.json")) != 0
    assert paths[2].name in refusal(capsys)


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (lambda camera: camera["K"][0].__setitem__(0, float("nan")), "NaN"),
        (lambda camera: camera["K"][1].__setitem__(1, float("inf")), "Infinity"),
        (lambda camera: camera["K"][0].__setitem__(0, 0.0), "fx is 0 px"),
        (lambda camera: camera["K"][1].__setitem__(1, -525.0), "fy is -525 px"),
        (lambda camera: camera.update(T_world_camera=np.zeros((4, 4)).tolist()), "T_world_camera"),
        (lambda camera: camera.update(T_world_camera=np.diag([2.0, 2, 2, 1]).tolist()), "not a rotation"),
        (lambda camera: camera.update(depth_scale=0.0), "depth_scale"),
        (lambda camera: camera.update(distortion=[1.0, 2.0, 3.0]), "distortion"),
    ],
    ids=["K NaN", "K infinite", "fx zero", "fy negative", "T singular", "T scales", "depth scale zero", "3 distortion"],
)
def test_an_impossible_calibration_is_refused_and_named(recording, capsys, spoil, said):
    change(recording, lambda document: spoil(document["cameras"][0]))
    assert track(recording) == BAD_INPUT
    message = refusal(capsys)
    assert said in message
    assert "sequence.json" in message


def test_a_frame_without_any_depth_at_the_start_is_lost_and_the_hand_is_found_after_it(recorded, recording):
    write_depths(recording, {0: np.zeros((480, 640))})
    assert track(recording, "--no-calibration", "--annotations", "none") == 0
    found = statuses(recording)
    assert found[0] == "lost"
    assert found[1:] == ["recovered", "ok", "ok"]
    with np.load(recording.parent / "track" / "track.npz") as arrays:
        assert recorded.joint_errors(arrays["frame"], arrays["joints_3d"])[1:].max() < 5e-3  # m


def test_an_annotated_start_without_depth_is_not_believed(recording):
    write_depths(recording, {0: np.zeros((480, 640))})
    assert track(recording, "--no-calibration") == 0
    assert statuses(recording)[0] == "lost"


def test_a_recording_of_nothing_is_lost_in_every_frame(recording):
    write_depths(recording, dict.fromkeys(range(4), np.zeros((480, 640))))
    assert track(recording) == 0
    assert statuses(recording) == ["lost"] * 4


def at(x: float, y: float, z: float, turn: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> np.ndarray:
    T = se3.exp(np.r_[0.0, 0.0, 0.0, turn])
    T[:3, 3] = x, y, z
    return T


def room(table_m: float, noise_mm: float, seed: int) -> np.ndarray:
    """(480, 640) mm: a wall, and a table with a box and a bottle on it, with a sensor's noise."""
    rng = np.random.default_rng(seed)
    meshes = [
        trimesh.creation.box((4.0, 4.0, 0.1), transform=at(0.0, 0.0, table_m + 1.0)),
        trimesh.creation.box((1.6, 0.04, 0.8), transform=at(0.0, 0.27, table_m + 0.1, (0.1, 0.0, 0.0))),
        trimesh.creation.box((0.20, 0.16, 0.12), transform=at(-0.2, 0.16, table_m, (0.1, 0.4, 0.0))),
        trimesh.creation.cylinder(0.035, 0.22, transform=at(0.15, 0.13, table_m - 0.1, (1.67, 0.0, 0.0))),
    ]
    mesh = cast(trimesh.Trimesh, trimesh.util.concatenate(meshes))
    K = np.array([[525.0, 0.0, 319.5], [0.0, 525.0, 239.5], [0.0, 0.0, 1.0]])
    depth = 1e3 * render_depth(np.array(mesh.vertices), np.array(mesh.faces, dtype=np.int32), K, 640, 480).depth
    return np.where(depth > 0, np.maximum(depth + noise_mm * rng.normal(size=depth.shape), 0), 0)


@pytest.mark.slow
@pytest.mark.parametrize("table", [0.6, 1.1])
def test_in_an_empty_room_no_hand_is_seen(recording, table):
    write_depths(recording, {index: room(table, 1.0, index) for index in range(4)})
    change(recording, lambda document: document["cameras"][0].pop("color", None))
    change(recording, lambda document: document.update(frame_count=2))
    assert track(recording, "--no-calibration", "--annotations", "none") == 0
    assert statuses(recording) == ["lost"] * 2


def test_in_a_room_that_the_hand_left_it_is_lost(recording):
    write_depths(recording, {index: room(0.8, 1.0, index) for index in (2, 3)})
    change(recording, lambda document: document["cameras"][0].pop("color", None))
    assert track(recording, "--no-calibration") == 0
    assert statuses(recording) == ["ok", "ok", "lost", "lost"]


@pytest.mark.parametrize("terms", ["LO", "LO+SC"])
def test_a_hand_without_fingertips_is_tracked_without_them(recorded, recording, terms):
    from dataclasses import replace

    model = default_hand("right")
    assert model.hand is not None
    nothing = tuple(np.zeros(0, dtype=np.int64) for _ in range(5))
    bare = replace(model, hand=replace(model.hand, fingertips=nothing, finger_parts={}))
    save_npz_model(bare, recording / "bare.npz")
    assert track(recording, "--hand", f"right={recording / 'bare.npz'}", "--no-calibration", "--terms", terms) == 0
    assert statuses(recording) == ["ok"] * 4
    with np.load(recording.parent / "track" / "track.npz") as arrays:
        assert recorded.joint_errors(arrays["frame"], arrays["joints_3d"]).max() < 2e-3  # m


def test_an_object_in_place_of_a_hand_is_refused(recording, capsys):
    trimesh.creation.icosphere(radius=0.03).export(recording / "ball.ply")
    assert track(recording, "--hand", f"right={recording / 'ball.ply'}") == BAD_INPUT
    assert "is not a hand" in refusal(capsys)


def open_box(subdivisions: int) -> trimesh.Trimesh:
    """A box's walls and floor, without a lid and with a hole in one wall; four times the faces for each subdivision."""
    box = trimesh.creation.box((0.05, 0.06, 0.08))
    for _ in range(2 + subdivisions):
        box = box.subdivide()
    middles = box.triangles_center
    is_lid = middles[:, 1] < -0.0299
    is_hole = (middles[:, 0] > 0.0249) & (np.linalg.norm(middles[:, 1:], axis=1) < 0.012)
    box.update_faces(~(is_lid | is_hole))
    box.remove_unreferenced_vertices()
    return box


def handling(folder: Path, mesh: trimesh.Trimesh, frames: int, aside: float = 0.12) -> tuple[Path, np.ndarray]:
    """A recording of a hand that opens and closes beside a thing that moves a little, and the thing's motion.

    At 0.12 m they are apart; at 0.07 m the thumb is in the thing.
    """
    path = folder / "thing.ply"
    mesh.export(path)
    model = load_object(path, max_faces=None)
    hand = perform({"right": default_hand("right")}, "open-close", 60)
    motion = np.array([at(aside + 0.0005 * t, 0.0, 0.5, (0.5, 0.6 + 0.01 * t, 0.2)) for t in range(60)])
    actor = Actor("thing", model, motion[:, None, :3, :], (0.1, 0.3, 0.6))
    camera = Camera("cam0", 640, 480, hand.camera.K)
    performance = Performance("handling", 30.0, camera, (*hand.actors, actor))
    write_recording(performance, folder / "recording", RecordingOptions(range(frames)), save_npz_model)
    return folder / "recording", motion


@pytest.mark.parametrize("subdivisions", [0, 3], ids=["as it is", "decimated"])
def test_a_mesh_with_holes_is_followed_with_collision_and_physics(tmp_path, subdivisions):
    pytest.importorskip("pybullet")
    recording, motion = handling(tmp_path, open_box(subdivisions), 4)
    assert track(recording, "--terms", "LO+CP", "--no-calibration") == 0
    assert statuses(recording) == ["ok"] * 4
    with np.load(tmp_path / "track" / "track.npz") as arrays:
        corner = np.array([0.025, 0.03, 0.04, 1.0])
        found = arrays["T_world_object"][:, 0] @ corner
        assert np.linalg.norm(found - motion[:4] @ corner, axis=1).max() < 3e-3  # m


@pytest.mark.parametrize("terms", ["LO+C", "LO+P", "LO+CP"])
def test_a_mesh_with_holes_that_a_finger_is_in_moves_nothing_far(recorded, tmp_path, terms):
    if "P" in terms:
        pytest.importorskip("pybullet")
    recording, motion = handling(tmp_path, open_box(0), 4, aside=0.07)
    assert track(recording, "--terms", terms, "--no-calibration") == 0
    assert statuses(recording) == ["ok"] * 4
    with np.load(tmp_path / "track" / "track.npz") as arrays:
        assert recorded.joint_errors(arrays["frame"], arrays["joints_3d"]).max() < 3e-3  # m
        assert np.linalg.norm(arrays["T_world_object"][:, 0, :3, 3] - motion[:4, :3, 3], axis=1).max() < 3e-3  # m


def test_an_object_is_found_where_nobody_placed_it(tmp_path):
    recording, motion = handling(tmp_path, trimesh.creation.box((0.03, 0.05, 0.08)), 3)
    change(recording, lambda document: document["objects"][0].pop("initial"))
    assert track(recording, "--no-calibration") == 0
    assert statuses(recording) == ["ok"] * 3
    with np.load(tmp_path / "track" / "track.npz") as arrays:
        assert np.linalg.norm(arrays["T_world_object"][:, 0, :3, 3] - motion[:3, :3, 3], axis=1).max() < 2e-3  # m
        assert arrays["object_status"].tolist() == [["ok"]] * 3
    summary = json.loads((tmp_path / "track" / "summary.json").read_text())
    assert summary["objects"] == {"thing": {"ok": 3, "lost": 0, "recovered": 0, "hidden": 0}}


def test_an_object_that_is_nowhere_is_an_error_that_says_what_to_do(recording, capsys):
    trimesh.creation.box((0.10, 0.06, 0.02)).export(recording / "box.ply")
    change(recording, lambda document: document.update(objects=[{"name": "box", "model": "box.ply"}]))
    assert track(recording, "--no-calibration") == BAD_INPUT
    message = refusal(capsys)
    assert "box: not found in frames 0" in message
    assert "initial.T_world_object" in message


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"v nan 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 2 3\nf 2 3 4\n", "not finite"),
        (b"v 0 0 0\nv 0.1 0 0\nv 0.2 0 0\nf 1 2 3\n", "no triangles with an area"),
        (b"v 0 0 0\nv 1e8 0 0\nv 0 1e8 0\nv 0 0 1e8\nf 1 2 3\nf 2 3 4\nf 1 2 4\nf 1 3 4\n", "in no unit"),
        (b"", "needed triangles"),
    ],
    ids=["NaN", "flat", "as large as a planet", "empty"],
)
def test_an_impossible_mesh_is_refused_with_the_facts(recording, capsys, content, said):
    (recording / "thing.obj").write_bytes(content)
    entry = {"name": "thing", "model": "thing.obj"}
    change(recording, lambda document: document.update(objects=[entry]))
    assert track(recording, "--no-calibration") == BAD_INPUT
    message = refusal(capsys)
    assert said in message
    assert "thing.obj" in message
