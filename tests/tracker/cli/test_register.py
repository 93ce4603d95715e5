"""`handloom register` on folders of scans: what it writes, skips and refuses."""

from __future__ import annotations

import argparse
import json
import re

import numpy as np
import pytest
import trimesh

from tests.tracker.registration.conftest import scan_model
from tracker.capture.scan import load_scan, save_scan
from tracker.cli import add_commands
from tracker.cli.register import list_scans, name_scans
from tracker.errors import TrackerError
from tracker.registration.registration_files import PLY_FILE, SURFACE_FILE, load_registration


def run(*words: object) -> int:
    parser = argparse.ArgumentParser()
    add_commands(parser.add_subparsers())
    args = parser.parse_args([str(word) for word in words])
    return args.run(args)


@pytest.fixture(scope="module")
def scans(tmp_path_factory):
    """A good scan with its row in scans.json, and a broken one."""
    folder = tmp_path_factory.mktemp("scans")
    save_scan(scan_model(2, 4000, side="left").scan, folder / "one.ply")
    (folder / "broken.obj").write_text("v 1 2 x\n")
    (folder / "scans.json").write_text(json.dumps({"scans": [{"file": "one.ply", "subject": 7, "pose": "flat"}]}))
    return folder


def test_each_scan_gets_its_files_and_a_row_and_a_second_run_skips_what_is_done(scans, tmp_path, capsys):
    assert run("register", scans, "--out", tmp_path, "--side", "left", "--json") == 0
    rows = json.loads(capsys.readouterr().out)
    assert [row["scan"] for row in rows] == ["broken", "one"]
    broken, one = rows
    assert broken["verdict"] == "bad" and "found a coordinate that is not a number" in broken["reasons"][0]
    assert {"scan", "seconds", "verdict", "scan_to_mesh_mm"} <= set(one) and one["seconds"] > 0.0
    assert set(one["scan_to_mesh_mm"]) == {"mean", "median", "p95"} and one["scan_to_mesh_mm"]["median"] < 0.3
    registration = load_registration(tmp_path / "one")
    assert (registration.subject, registration.pose_name, registration.side) == ("7", "flat", "left")
    mesh = load_scan(tmp_path / "one" / "registration.ply")
    assert len(mesh.points) == len(registration.vertices)
    coarse, fine = (trimesh.load(tmp_path / "one" / name, process=False) for name in (PLY_FILE, SURFACE_FILE))
    assert np.array_equal(fine.vertices[: len(coarse.vertices)], coarse.vertices)
    assert len(fine.faces) == 16 * len(coarse.faces)
    stamp = (tmp_path / "one" / "registration.npz").stat().st_mtime_ns
    assert run("register", scans, "--out", tmp_path, "--side", "left", "--json") == 0
    assert json.loads(capsys.readouterr().out)[1] == one
    assert (tmp_path / "one" / "registration.npz").stat().st_mtime_ns == stamp
    warm = tmp_path / "warm"
    assert run("register", scans / "one.ply", "--out", warm, "--start", tmp_path) == 0
    assert "one: good" in capsys.readouterr().out
    apart = np.linalg.norm(load_registration(warm / "one").vertices - registration.vertices, axis=1)
    assert apart.mean() < 1e-3


def test_bad_input_is_said_with_exit_code_2(scans, tmp_path, capsys):
    for words, told in (
        ((scans / "broken.obj", "--out", tmp_path / "a"), "not a number"),
        ((scans / "nothing.ply", "--out", tmp_path / "a"), "cannot be read"),
        ((scans / "one.ply", "--out", tmp_path / "a", "--model", scans / "one.ply"), "one.ply"),
        ((scans / "one.ply", "--out", tmp_path / "a", "--processes", 0), "needed 1 to 256"),
        ((tmp_path, "--out", tmp_path / "a"), "No scans"),
    ):
        assert run("register", *words) == 2
        assert told in capsys.readouterr().err


def test_scans_that_share_a_name_are_told_apart_by_their_folder(tmp_path):
    paths = [tmp_path / "a" / "1.ply", tmp_path / "b" / "1.ply"]
    assert [name for _, name in name_scans(paths)] == ["a_1", "b_1"]
    with pytest.raises(TrackerError, match="would share the name a_1"):
        list(name_scans([*paths, tmp_path / "a" / "1.obj"]))


def test_truths_and_registrations_beside_scans_are_no_scans(tmp_path):
    for name in (
        "scans/a.ply",
        "truth/a.npz",
        "out/a/registration.npz",
        "out/a/registration.ply",
        "b/registration_surface.ply",
    ):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).touch()
    assert list_scans([tmp_path]) == [tmp_path / "scans" / "a.ply"]


@pytest.mark.slow
def test_bench_registration_prints_cold_and_warm_by_stage(capsys):
    assert run("bench", "registration", "--scans", 1, "--json") == 0
    found = json.loads(capsys.readouterr().out)
    for name in ("cold", "warm"):
        assert set(found[name]["stages_s"]) == {"prepare", "start", "model", "surface", "judge"}
        assert found[name]["median_s"] == pytest.approx(sum(found[name]["stages_s"].values()), abs=0.01)
    assert found["cold"]["median_s"] > found["warm"]["median_s"]
    assert run("bench", "registration", "--scans", 0) == 2
    assert re.search("needed 1 to 1000", capsys.readouterr().err)


@pytest.mark.slow
def test_a_unit_that_is_open_is_asked_for_and_scans_json_says_it(tmp_path, capsys):
    scan = scan_model(2, 4000).scan
    save_scan(scan.scaled(1 / 0.0285), tmp_path / "open.ply")
    assert run("register", tmp_path, "--out", tmp_path / "out") == 2
    assert "its unit (metres per unit)" in capsys.readouterr().err
    assert run("register", tmp_path, "--out", tmp_path / "out", "--metres-per-unit", "0.01") == 2
    assert "cm long with 1 unit = 10 mm" in capsys.readouterr().err
    listed, metres = tmp_path / "listed", tmp_path / "metres"
    listed.mkdir()
    metres.mkdir()
    save_scan(scan.scaled(1 / 0.0285), listed / "open.ply")
    (listed / "scans.json").write_text(json.dumps([{"file": "open.ply", "metres_per_unit": 0.0285}]))
    assert run("register", listed, "--out", tmp_path / "out", "--metres-per-unit", "0.01", "--json") == 0
    [row] = json.loads(capsys.readouterr().out)
    assert not row["is_unit_guessed"] and 0.1 < row["longest_m"] < 0.3
    save_scan(scan, metres / "hand.ply")
    assert run("register", metres, "--out", tmp_path / "out", "--side", "right") == 0
    assert "its unit is a guess" in capsys.readouterr().out
