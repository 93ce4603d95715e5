"""`handloom train-detector`."""

from __future__ import annotations

import json

import numpy as np
import pytest

from tracker.cli.__main__ import main
from tracker.detection import load_forest
from tracker.landmarks.network import DATA
from tracker.tracking.setup import TrackSetup
from tracker.tracking.tools import make_tools

QUICK = ["--trees", "3", "--tests", "500", "--patches", "1500", "--min-leaf", "10"]


@pytest.fixture(scope="module")
def recording(tmp_path_factory):
    out = tmp_path_factory.mktemp("recordings") / "count"
    assert main(["synthesize", "--motion", "count", "--frames", "0:24", "--out", str(out)]) == 0
    return out


@pytest.mark.parametrize("on", ["depth", "color"])
def test_a_detector_is_learnt_from_an_annotated_recording_and_judged(recording, tmp_path, capsys, on):
    out, curve = tmp_path / "new folder" / "tips.npz", tmp_path / "curve.csv"
    arguments = ["train-detector", str(recording), "--on", on, *QUICK, "--out", str(out)]
    assert main([*arguments, "--test", str(recording), "--curve", str(curve), "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    forest = load_forest(out)
    assert forest.kind == on == result["on"]
    assert forest.num_trees == 3
    assert result["images"] == 24
    assert result["bytes"] == out.stat().st_size
    assert result["test"]["auc"] > 0.6  # on what it was trained on
    rows = np.loadtxt(curve, delimiter=",", skiprows=1)
    assert (np.diff(rows[:, 0]) <= 0).all()
    assert (np.diff(rows[:, 2]) >= 0).all()


def test_renders_alone_do_and_the_same_seed_gives_the_same_file(tmp_path, capsys):
    files = []
    for name in ("one.npz", "other.npz"):
        out = tmp_path / name
        assert main(["train-detector", "--rendered", "25", *QUICK, "--out", str(out)]) == 0
        with np.load(out) as arrays:
            files.append({key: arrays[key].tobytes() for key in arrays.files})
    assert files[0] == files[1]
    assert "patches of 25 images" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ([], "Nothing to learn from"),
        (["nowhere"], "is no folder"),
        (["--rendered", "5", "--trees", "0"], "--trees is 0"),
        (["--rendered", "5", "--pixel-size", "nan"], "--pixel-size is nan"),
        (["--rendered", "5", "--curve", "x.csv"], "--curve needs --test"),
        (["--rendered", "1", "--per-image", "9"], "needed at least 40 of each"),
    ],
)
def test_what_cannot_be_learnt_from_is_said_and_leaves_no_file(arguments, said, tmp_path, capsys):
    out = tmp_path / "tips.npz"
    assert main(["train-detector", *arguments, "--out", str(out)]) == 2
    assert said in capsys.readouterr().err
    assert not out.exists()


def test_a_recording_without_annotations_is_refused(recording, tmp_path, capsys):
    import shutil

    bare = tmp_path / "bare"
    shutil.copytree(recording, bare)
    (bare / "annotations.json").unlink()
    assert main(["train-detector", str(bare), "--out", str(tmp_path / "tips.npz")]) == 2
    assert "has no annotations" in capsys.readouterr().err


def test_a_track_takes_a_detector_that_somebody_trained_and_keeps_it(recording, tmp_path, capsys):
    tips, out = tmp_path / "tips.npz", tmp_path / "track"
    assert main(["train-detector", str(recording), *QUICK, "--out", str(tips)]) == 0
    track = ["track", str(recording), "--frames", "0:2", "--no-calibration", "--detector"]
    assert main([*track, str(tips), "--out", str(out)]) == 0
    setup = TrackSetup.load(out)
    assert setup.fingertips is not None
    with make_tools(setup, np.eye(4)) as tools:
        assert tools.detector is setup.fingertips
        assert tools.detector.nodes.tobytes() == load_forest(tips).nodes.tobytes()


@pytest.mark.parametrize("name", ["landmarks.onnx", "noise", "model.npz"])
def test_a_file_that_is_no_detector_is_refused_before_anything_is_tracked(recording, tmp_path, capsys, name):
    file, out = tmp_path / name, tmp_path / "track"
    if name == "landmarks.onnx":
        file.write_bytes((DATA / name).read_bytes())
    elif name == "noise":
        file.write_bytes(np.random.default_rng(0).bytes(5000))
    else:
        np.savez(file, format=np.array(["something else"]))
    assert main(["track", str(recording), "--detector", str(file), "--out", str(out)]) == 2
    said = capsys.readouterr().err
    assert name in said and "needed" in said and "Traceback" not in said
    assert not out.exists()


def test_a_detector_that_the_run_would_not_use_is_refused(recording, tmp_path, capsys):
    words = ["--detector", str(tmp_path / "tips.npz"), "--terms", "LO", "--out", str(tmp_path / "track")]
    assert main(["track", str(recording), *words]) == 2
    assert "use no fingertips" in capsys.readouterr().err
