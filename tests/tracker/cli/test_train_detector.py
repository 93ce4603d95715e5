"""`handloom train-detector`."""

from __future__ import annotations

import json

import numpy as np
import pytest

from tracker.cli.__main__ import main
from tracker.detection import load_forest

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
