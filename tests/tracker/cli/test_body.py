"""`handloom body` writes what smplx loads and poses motions; bad files are refused in a sentence."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import trimesh

from tracker.cli.__main__ import main
from tracker.model.body_model import body_model
from tracker.model.body_motion import BodyMotion, save_body_motion
from tracker.model.mano_files import load_mano


@pytest.fixture(scope="module")
def motion(tmp_path_factory) -> tuple[BodyMotion, Path]:
    rng = np.random.default_rng(3)
    moved = BodyMotion(
        0.2 * rng.standard_normal((3, 52, 3)), rng.standard_normal((3, 3)), rng.standard_normal(20), 60.0, "female"
    )
    path = tmp_path_factory.mktemp("motion") / "wave.npz"
    save_body_motion(moved, path)
    return moved, path


@pytest.mark.parametrize("name", ["BODY.npz", "BODY.pkl"])
def test_the_exported_model_is_read_back_vertex_for_vertex(name: str, tmp_path: Path, capsys) -> None:
    assert main(["body", "export", "--to", str(tmp_path / name), "--population", "male", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    read, model = load_mano(tmp_path / name), body_model("male")
    assert np.array_equal(read.template, model.template) and np.array_equal(read.faces, model.faces)
    assert (told["joints"], told["num_betas"]) == (52, 20) and len(set(told["vertex_ids"].values())) == 21


@pytest.mark.parametrize("kind", ["obj", "ply"])
def test_a_posed_motion_is_one_mesh_a_frame_with_the_models_vertices(kind, motion, tmp_path: Path, capsys) -> None:
    moved, path = motion
    arguments = ["body", "pose", str(path), "--to", str(tmp_path / "out"), "--format", kind, "--frames", "1:3"]
    assert main([*arguments, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["files"] == 2
    assert sorted(p.name for p in (tmp_path / "out").iterdir()) == [f"00000{t}.{kind}" for t in (1, 2)]
    mesh = trimesh.load(tmp_path / "out" / f"000002.{kind}", process=False, maintain_order=True)
    wanted = body_model("female").pose_at(moved.poses[2], moved.shape, moved.translations[2]).vertices
    assert np.abs(mesh.vertices - wanted).max() < 1e-6


def test_an_animated_file_has_the_motions_bones_and_its_blend_shapes(motion, tmp_path: Path) -> None:
    moved, path = motion
    assert main(["body", "pose", str(path), "--to", str(tmp_path / "wave.glb")]) == 0
    scene = trimesh.load(tmp_path / "wave.glb", process=False)
    assert len(scene.geometry["body"].vertices) == 6683
    text = (tmp_path / "wave.glb").read_bytes()
    document = json.loads(text[20 : 20 + int.from_bytes(text[12:16], "little")])
    assert len(document["skins"][0]["joints"]) == 52 and len(document["animations"][0]["channels"]) == 52 + 2
    assert 1 <= len(document["meshes"][0]["primitives"][0]["targets"]) <= len(moved)


@pytest.mark.parametrize(
    ("content", "what"),
    [(b"no archive", "damaged"), (None, "no such file"), ({"poses": np.zeros((2, 165))}, "156")],
)
def test_a_bad_motion_is_refused_by_name_in_a_sentence(content, what: str, tmp_path: Path, capsys) -> None:
    path = tmp_path / "bad.npz"
    if isinstance(content, bytes):
        path.write_bytes(content)
    elif content is not None:
        np.savez(path, **content)
    assert main(["body", "pose", str(path), "--to", str(tmp_path / "out")]) == 2
    said = capsys.readouterr().err
    assert "bad.npz" in said and what in said and not (tmp_path / "out").exists()


@pytest.mark.parametrize("arguments", [["export", "--to", "body.txt"], ["export", "--to", "nowhere/body.npz"]])
def test_a_place_that_cannot_be_written_is_said_before_anything_is_done(arguments, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["body", *arguments]) == 2
    said = capsys.readouterr().err
    assert "give the file such a name" in said or "make it first" in said
    assert list(tmp_path.iterdir()) == []


def test_more_shapes_than_the_body_has_are_refused_with_both_numbers(tmp_path: Path, capsys) -> None:
    save_body_motion(BodyMotion(np.zeros((1, 52, 3)), np.zeros((1, 3)), np.ones(25)), tmp_path / "many.npz")
    assert main(["body", "pose", str(tmp_path / "many.npz"), "--to", str(tmp_path / "out")]) == 2
    said = capsys.readouterr().err
    assert "25" in said and "20" in said
