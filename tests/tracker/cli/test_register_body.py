"""`handloom register-body` and `register-body-sequence`: bad files are named, the rest goes on, and nothing is lost."""

from __future__ import annotations

import json
import os
import pickle
import signal
import subprocess
import sys
import time
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from tracker.bodies.body_registration import load_body_registration
from tracker.bodies.chunks import CHAIN
from tracker.capture.scan import save_scan
from tracker.cli.__main__ import main
from tracker.model.body_motion import load_body_motion
from tracker.synthesis.bodies.generate import BODY_SCANNER
from tracker.synthesis.bodies.moving import MovingOptions, make_motion

SCANNER = replace(BODY_SCANNER, num_points=25_000, pixels=500)


class Hostile:
    def __reduce__(self):
        return os.system, ("touch hostile_ran",)


@pytest.fixture(scope="module")
def scans(tmp_path_factory) -> Path:
    """Four scans of somebody who stands nearly still, and among them an empty and a broken file."""
    folder = tmp_path_factory.mktemp("moving")
    moving = make_motion(5, 4, options=MovingOptions(still=2, missing=0.0))
    for t, name in enumerate(("00", "01", "03", "05")):
        save_scan(moving.scan(t, SCANNER).scan, folder / f"{name}.ply")
    (folder / "02.ply").write_bytes(b"")
    (folder / "04.ply").write_bytes((folder / "03.ply").read_bytes()[:3000])
    return folder


def test_bad_scans_are_named_in_a_sentence_each_and_a_hostile_pickle_never_runs(tmp_path, monkeypatch, capsys) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "empty.ply").write_bytes(b"")
    (tmp_path / "hostile.npz").write_bytes(pickle.dumps(Hostile()))
    np.savez(tmp_path / "objects.npz", points=np.array([Hostile()], dtype=object))
    save_dot = np.zeros((80, 3)) + 0.01 * np.random.default_rng(0).standard_normal((80, 3))
    np.savez(tmp_path / "dot.npz", points=save_dot)
    names = ["empty.ply", "hostile.npz", "objects.npz", "dot.npz", "nowhere.ply"]
    assert main(["register-body", *names, "--out", "out"]) == 2
    said = capsys.readouterr().err
    assert all(name in said for name in names) and not (tmp_path / "hostile_ran").exists()


def test_a_hostile_model_is_refused_by_name_and_never_runs(tmp_path, monkeypatch, capsys) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "body.pkl").write_bytes(pickle.dumps(Hostile()))
    (tmp_path / "scan.ply").write_bytes(b"")
    assert main(["register-body", "scan.ply", "--model", "body.pkl", "--out", "out"]) == 2
    assert "body.pkl" in capsys.readouterr().err and not (tmp_path / "hostile_ran").exists()


@pytest.mark.slow
def test_a_sequence_killed_amid_its_frames_goes_on_and_ends_as_if_it_had_not_been(scans: Path, tmp_path: Path) -> None:
    def command(out: Path) -> list[str]:
        return [sys.executable, "-m", "tracker.cli", "register-body-sequence", str(scans), "--out", str(out), "--json"]

    killed = subprocess.Popen(command(tmp_path / "killed"), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    first = tmp_path / "killed" / "frames" / "000000" / "body.npz"
    deadline = time.monotonic() + 500
    while not first.exists():
        assert killed.poll() is None and time.monotonic() < deadline
        time.sleep(0.05)
    killed.send_signal(signal.SIGKILL)
    killed.wait()
    before = first.stat().st_mtime_ns
    told = json.loads(subprocess.run(command(tmp_path / "killed"), check=True, capture_output=True).stdout)
    assert first.stat().st_mtime_ns == before, "what was done is not done again"
    assert (told["frames"], told["registered"]) == (6, 4)
    assert len(told["errors"]) == 2 and "02.ply" in told["errors"][0] and "04.ply" in told["errors"][1]
    subprocess.run(command(tmp_path / "whole"), check=True, capture_output=True)
    for frame in (0, 1, 3, 5):
        one, other = (
            load_body_registration(tmp_path / name / "frames" / f"{frame:06d}") for name in ("killed", "whole")
        )
        assert np.array_equal(one.vertices, other.vertices)
    assert len(load_body_motion(tmp_path / "whole" / "motion.npz")) == 6


@pytest.mark.slow
def test_chunks_join_without_a_seam(scans: Path, tmp_path: Path) -> None:
    arguments = ["register-body-sequence", str(scans), "--out", str(tmp_path / "out"), "--chunk", "2", "--json"]
    assert main(arguments) == 0
    found = [load_body_registration(tmp_path / "out" / "frames" / f"{frame:06d}") for frame in (0, 1, 3, 5)]
    steps = [np.linalg.norm(b.vertices - a.vertices, axis=1).mean() for a, b in pairwise(found)]
    assert max(steps) < 0.004, "m a frame, of somebody who stands nearly still"
    assert [each.measures.get(CHAIN) for each in found] == [None, None, 0.0, 1.0], "each goes on from the chunk before"
    assert main([*arguments[:-1], "--no-hold"]) == 2, "another way into the same folder is refused"
