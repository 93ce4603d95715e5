"""`handloom train-detector`."""

from __future__ import annotations

import json

import numpy as np
import pytest

from tracker.cli.__main__ import main
from tracker.detection import load_detector, load_forest
from tracker.detection.default_detector import DATA as DEFAULT
from tracker.fitting.setup import TrackSetup
from tracker.landmarks.network import DATA
from tracker.search.tools import make_tools
from tracker.tracking.chunk import TrackChunk
from tracker.tracking.frame_result import STATUSES

QUICK = ["--trees", "3", "--tests", "500", "--patches", "1500", "--min-leaf", "10"]


@pytest.fixture(scope="module")
def recording(tmp_path_factory):
    out = tmp_path_factory.mktemp("recordings") / "count"
    assert main(["synthesize", "--motion", "count", "--frames", "0:24", "--out", str(out)]) == 0
    return out


@pytest.fixture(scope="module")
def trained(recording, tmp_path_factory):
    """A detector for depth and one for colour."""
    folder = tmp_path_factory.mktemp("detectors")
    files = {on: folder / f"{on}.npz" for on in ("depth", "color")}
    for on, file in files.items():
        assert main(["train-detector", str(recording), "--on", on, *QUICK, "--out", str(file)]) == 0
    return files


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
        (["nowhere"], "is not a folder"),
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


NAILS = ["train-detector", "--what", "nails", *QUICK]


@pytest.fixture(scope="module")
def views(tmp_path_factory):
    """Textured colour views of a hand with nails."""
    out = tmp_path_factory.mktemp("views") / "count"
    words = ["--motion", "open-close", "--frames", "20:50", "--step", "5", "--cameras", "3", "--texture", "--nails"]
    assert main(["synthesize", *words, "--out", str(out)]) == 0
    return out


@pytest.mark.slow
def test_nails_are_learnt_from_annotated_views_and_renders_and_looked_for_in_views(views, tmp_path, capsys):
    nails, out = tmp_path / "nails.npz", tmp_path / "track"
    words = [str(views), "--rendered", "20", "--test", str(views), "--json", "--out", str(nails)]
    assert main([*NAILS, *words]) == 0
    result = json.loads(capsys.readouterr().out)
    assert (result["what"], result["on"], result["images"]) == ("nails", "color", 3 * 6 + 20)
    assert result["test"]["nails"] > 20 and result["test"]["auc"] > 0.5  # on what it was trained on
    forest = load_forest(nails)
    assert (forest.what, forest.kind, forest.num_trees) == ("nails", "color", 3)
    track = ["track", str(views), "--frames", "0:2", "--no-calibration", "--detector", str(nails), "--out", str(out)]
    assert main([*track, "--cameras", "cam0,cam1,cam2", "--no-depth"]) == 0
    assert "nails" in [str(name) for name in TrackChunk.load(out / "frames.npz").cost_names]
    assert TrackSetup.load(out).nail_detector is not None
    assert main([*track[:-1], str(tmp_path / "depth")]) == 2
    assert (
        "nails.npz: It finds finger nails in colour views, but a depth camera is tracked in" in capsys.readouterr().err
    )


@pytest.mark.parametrize(
    ("words", "said"), [(["--rendered", "5", "--on", "depth"], "not visible in depth"), ([], "Nothing to learn from")]
)
def test_what_nails_cannot_be_learnt_from_is_said(words, said, tmp_path, capsys):
    out = tmp_path / "nails.npz"
    assert main([*NAILS, *words, "--out", str(out)]) == 2
    assert said in capsys.readouterr().err and not out.exists()


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
    setup, own = TrackSetup.load(out), load_detector(tips)
    assert setup.own_detector is not None
    assert (setup.own_detector.name, setup.own_detector.sha256) == ("tips.npz", own.sha256)
    assert json.loads((out / "summary.json").read_text())["detector"] == own.to_json()
    with make_tools(setup, np.eye(4)) as tools:
        assert tools.detector is not None and tools.detector is setup.own_detector.forest
        assert tools.detector.nodes.tobytes() == own.forest.nodes.tobytes()


@pytest.mark.parametrize("words", [[], ["--no-detector"], ["--preset", "t16"]])
@pytest.mark.parametrize("on", ["depth", "color"])
def test_fingertips_of_a_detector_of_ones_own_count_in_every_frame(recording, trained, tmp_path, on, words):
    """What the hand detector sees in the colour image does not silence it; one that looks at colour is given colour."""
    out = tmp_path / "track"
    track = ["track", str(recording), "--frames", "0:3", "--no-calibration", *words, "--terms", "LO+S"]
    assert main([*track, "--iterations", "3", "--detector", str(trained[on]), "--out", str(out)]) == 0
    chunk = TrackChunk.load(out / "frames.npz")
    assert chunk.status.tolist() == [STATUSES.index("ok")] * 3
    salient = [str(name) for name in chunk.cost_names].index("salient")
    assert np.isfinite(chunk.costs[:, salient]).all()
    assert np.count_nonzero(chunk.costs[:, salient]) >= 2


def test_a_detector_that_looks_at_colour_is_refused_where_there_is_none(recording, trained, tmp_path, capsys):
    import shutil

    bare = tmp_path / "bare"
    shutil.copytree(recording, bare)
    document = json.loads((bare / "sequence.json").read_text())
    del document["cameras"][0]["color"]
    (bare / "sequence.json").write_text(json.dumps(document))
    track = ["track", str(bare), "--detector", str(trained["color"]), "--out", str(tmp_path / "track")]
    assert main(track) == 2
    assert "color.npz: The fingertip detector looks at colour" in capsys.readouterr().err


@pytest.mark.parametrize("name", ["landmarks.onnx", "palms.npz", "noise", "model.npz", "empty", "huge.npz", "folder"])
def test_a_file_that_is_no_detector_is_refused_before_anything_is_tracked(recording, tmp_path, capsys, name):
    file, out = tmp_path / name, tmp_path / "track"
    if name in ("landmarks.onnx", "palms.npz"):  # a network under its own name and under a wrong one
        file.write_bytes((DATA / name).with_suffix(".onnx").read_bytes())
    elif name == "huge.npz":
        with file.open("wb") as out_file:  # takes no room on the disk
            out_file.write(b"PK\x03\x04")
            out_file.truncate(2**33)
    elif name == "empty":
        file.touch()
    elif name == "folder":
        file.mkdir()
    elif name == "noise":
        file.write_bytes(np.random.default_rng(0).bytes(5000))
    else:
        np.savez(file, format=np.array(["something else"]))
    assert main(["track", str(recording), "--detector", str(file), "--out", str(out)]) == 2
    said = capsys.readouterr().err
    assert name in said and "needed a fingertip detector as `handloom train-detector` writes it" in said
    assert "Traceback" not in said and len(said.strip().splitlines()) == 1
    assert not out.exists()


def test_a_detector_that_the_run_would_not_use_is_refused(recording, tmp_path, capsys):
    words = ["--detector", str(DEFAULT), "--terms", "LO", "--out", str(tmp_path / "track")]
    assert main(["track", str(recording), *words]) == 2
    assert "use no fingertips" in capsys.readouterr().err
