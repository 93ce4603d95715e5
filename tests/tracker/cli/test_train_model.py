"""`handloom train-model` and `handloom model-loop` on registrations that are there already."""

import json
from dataclasses import replace

import numpy as np
import pytest

from tracker.capture.scan import Scan, load_scan, save_scan
from tracker.cli.__main__ import main
from tracker.model.blend_files import load_blend_model
from tracker.model.untrained_hand import untrained_hand
from tracker.registration.register import refuse
from tracker.registration.registration import digest_model, digest_scan
from tracker.registration.registration_files import save_registration
from tracker.synthesis.scans.generate import generate_truth


@pytest.fixture(scope="module")
def loop(tmp_path_factory):
    """Scans and their true registrations of three people in eight poses, as a first round would leave them."""
    folder = tmp_path_factory.mktemp("loop")
    model = untrained_hand("right")
    digest = digest_model(model)
    (folder / "scans").mkdir()
    rows = []
    for subject in (1, 2, 3):
        for pose in (0, 2, 5, 9, 11, 13, 20, 40):
            truth = generate_truth(subject, pose)
            path = folder / "scans" / f"s{subject}_{pose}.ply"
            save_scan(Scan(truth.vertices, np.zeros_like(truth.vertices), name=path.stem), path)
            scan = load_scan(path)
            made = refuse(scan, model, digest, (), 0.0)
            made = replace(
                made,
                vertices=truth.vertices,
                model_vertices=truth.vertices,
                side="right",
                verdict="good",
                scan_digest=digest_scan(scan),
                subject=f"s{subject}",
                pose_name=truth.pose_name,
                scan_to_mesh=np.zeros(len(scan.points)),
            )
            save_registration(made, folder / "out" / "round_1" / "registrations" / path.stem)
            rows.append(path.stem)
    return folder, rows


def test_a_model_is_trained_from_a_folder(loop, capsys):
    folder, _ = loop
    out = folder / "hand.npz"
    assert main(["train-model", str(folder / "out"), "--out", str(out), "--rounds-of-training", "1", "--json"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert said["registrations"] == 24 and said["people"] == 3
    assert load_blend_model(out).provenance["training_set"] == said["training_set"]
    report = json.loads(out.with_suffix(".json").read_text())
    assert set(report["by_hand"]) == {"s1", "s2", "s3"} and report["residual_mm"] < 1.5


def test_the_loop_keeps_what_is_there(loop, capsys):
    folder, _ = loop
    command = ["model-loop", str(folder / "scans"), "--out", str(folder / "out"), "--rounds", "1", "--json"]
    command += ["--rounds-of-training", "1", "--no-pose-shapes", "--metres-per-unit", "1"]
    assert main(command) == 0
    first = json.loads(capsys.readouterr().out)
    assert first["rounds"][0]["registered"] == {"good": 24}
    model = folder / "out" / "round_1" / "model.npz"
    made = model.stat().st_mtime_ns
    assert main(command) == 0
    assert json.loads(capsys.readouterr().out) == first and model.stat().st_mtime_ns == made


@pytest.mark.parametrize("form", ["lines", "list", "decisions"])
def test_only_what_was_accepted_is_learnt_from(loop, capsys, tmp_path, form):
    folder, names = loop
    text = {
        "lines": "\n".join(names[:20]),
        "list": json.dumps(names[:20]),
        "decisions": json.dumps({name: "accepted" if place < 20 else "rejected" for place, name in enumerate(names)}),
    }[form]
    (tmp_path / "accepted").write_text(text)
    command = ["train-model", str(folder / "out"), "--out", str(tmp_path / "hand.npz"), "--rounds-of-training", "1"]
    assert main([*command, "--accepted", str(tmp_path / "accepted"), "--no-pose-shapes", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["registrations"] == 20


def test_bad_input_is_said(tmp_path, capsys):
    for command in (
        ["train-model", str(tmp_path), "--out", str(tmp_path / "hand.npz")],
        ["train-model", str(tmp_path), "--out", str(tmp_path / "hand.ply")],
        ["train-model", str(tmp_path), "--out", str(tmp_path / "hand.npz"), "--accepted", str(tmp_path / "none")],
        ["model-loop", str(tmp_path), "--out", str(tmp_path / "out"), "--rounds", "0"],
        ["model-loop", str(tmp_path), "--out", str(tmp_path / "out")],
    ):
        assert main(command) == 2
        assert capsys.readouterr().err.startswith("handloom: ")
