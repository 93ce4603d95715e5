import json

import numpy as np
import pytest

from tracker.capture.scan import load_scan
from tracker.cli.__main__ import main
from tracker.synthesis.scans.generate import generate_truth
from tracker.synthesis.scans.scan_set import LIST

COMMAND = ["synthesize-scans", "--subjects", "2,33", "--poses", "fist", "--sides", "left", "--points", "2000"]


def test_scans_are_written_with_their_truth_and_listed(tmp_path, capsys):
    out = tmp_path / "scans"
    assert main([*COMMAND, "--forearm", "half", "--surfaces", "--json", "--out", str(out)]) == 0
    assert json.loads(capsys.readouterr().out)["scans"] == 2
    rows = json.loads((out / LIST).read_text())["scans"]
    assert [(row["subject"], row["pose"], row["has_forearm"]) for row in rows] == [
        ("2", "fist", True),
        ("33", "fist", False),
    ]
    scan = load_scan(out / rows[0]["file"])
    with np.load(out / rows[0]["truth"]) as truth:
        assert truth["is_hand"].shape == (2000,)
        assert len(scan.points) == 2000
        assert str(truth["side"]) == "left"
        own = generate_truth(2, "fist", "left").vertices
        edges = np.linalg.norm(truth["vertices"][1:] - truth["vertices"][:-1], axis=1)
        assert np.allclose(edges, np.linalg.norm(own[1:] - own[:-1], axis=1), atol=1e-12)
        assert truth["surface_vertices"].shape[1] == 3
        # The scan file holds the true hand, a left one: its points lie on the surface.
        low, high = truth["surface_vertices"].min(axis=0), truth["surface_vertices"].max(axis=0)
        assert np.all(scan.points > low - 2e-3)
        assert np.all(scan.points < high + 2e-3)


def test_an_interrupted_run_goes_on_and_other_settings_are_refused(tmp_path, capsys):
    out = str(tmp_path / "scans")
    assert main([*COMMAND, "--out", out]) == 0
    files = sorted((tmp_path / "scans").rglob("*.*"))
    before = {path: path.read_bytes() for path in files}
    gone = next(path for path in files if path.parent.name == "truth")
    gone.unlink()
    kept = next(path for path in files if path.suffix == ".ply" and path.stem != gone.stem)
    stamp = kept.stat().st_mtime_ns
    assert main([*COMMAND, "--out", out]) == 0
    assert {path: path.read_bytes() for path in files} == before
    assert kept.stat().st_mtime_ns == stamp
    assert main([*COMMAND, "--noise-mm", "0.5", "--out", out]) == 2
    assert "other settings" in capsys.readouterr().err


@pytest.mark.parametrize(
    "wrong",
    [
        ["--subjects", "0"],
        ["--subjects", "1-9999999999"],
        ["--subjects", "somebody"],
        ["--poses", "fist,nonsense"],
        ["--sides", "middle"],
        ["--points", "5"],
        ["--noise-mm", "nan"],
    ],
    ids=" ".join,
)
def test_nonsense_is_refused_with_a_word(tmp_path, capsys, wrong):
    assert main(["synthesize-scans", *wrong, "--out", str(tmp_path / "x")]) == 2
    assert len(capsys.readouterr().err) > 20
