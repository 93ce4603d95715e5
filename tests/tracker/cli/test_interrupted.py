"""Commands that are stopped in the middle by Ctrl-C or killed leave whole files only, and go on with them."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tracker.capture.scan import Scan, save_scan
from tracker.model.untrained_hand import untrained_hand
from tracker.registration.register import refuse
from tracker.registration.registration import digest_model
from tracker.registration.registration_files import load_registration, save_registration
from tracker.synthesis.scans.generate import ScanOptions, generate_scan, generate_truth
from tracker.synthesis.scans.scanner import Scanner

ROOT = Path(__file__).resolve().parents[3]

NUM_SCANS = 8
"""Two are under way and three wait in the pool when Ctrl-C comes: the rest is not begun, however slow the signal."""


def start(*words: object) -> subprocess.Popen[str]:
    """A command with a terminal's group of its own, which hears Ctrl-C even where tests run in the background."""
    command = [sys.executable, "-m", "tracker.cli", *map(str, words)]
    pipe = subprocess.PIPE
    return subprocess.Popen(
        command, cwd=ROOT, stdout=pipe, stderr=pipe, text=True, start_new_session=True, preexec_fn=_hear_interrupts
    )


def _hear_interrupts() -> None:
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def wait_for(process: subprocess.Popen[str], is_so, seconds: float = 240.0) -> None:
    ends = time.monotonic() + seconds
    while not is_so():
        assert process.poll() is None and time.monotonic() < ends, process.communicate()
        time.sleep(0.01)


def list_files(folder: Path) -> set[str]:
    return {path.name for path in folder.rglob("*") if path.is_file()}


@pytest.mark.slow
def test_registering_with_several_processes_is_stopped_by_ctrl_c_and_goes_on(tmp_path):
    scans, out = tmp_path / "scans", tmp_path / "out"
    scans.mkdir()
    options = ScanOptions(scanner=Scanner(num_points=3000), has_forearm=False)
    for number in range(NUM_SCANS):
        save_scan(generate_scan(1 + number, 0, "right", number, options).scan, scans / f"{number}.ply")
    words = ("register", scans, "--out", out, "--side", "right", "--processes", 2)
    stopped = start(*words)
    wait_for(stopped, lambda: any(out.glob("*/registration.npz")))
    os.killpg(stopped.pid, signal.SIGINT)
    _, said = stopped.communicate(timeout=120)
    assert stopped.returncode == 130 and said.rstrip().endswith("handloom: stopped") and "Traceback" not in said
    assert list_files(out) == {"registration.npz", "registration.ply", "registration_surface.ply"}, (
        "no file is left half written"
    )
    done = {path: path.stat().st_mtime_ns for path in out.glob("*/registration.npz")}
    assert 1 <= len(done) < NUM_SCANS and all(load_registration(path).verdict == "good" for path in done)
    again = start(*words, "--json")
    rows, said = again.communicate(timeout=240)
    assert again.returncode == 0, said
    assert [row["scan"] for row in json.loads(rows)] == [str(number) for number in range(NUM_SCANS)]
    assert {path: path.stat().st_mtime_ns for path in done} == done, "what was done is not done again"


@pytest.fixture
def registered(tmp_path):
    """True registrations of two people."""
    model = untrained_hand("right")
    digest = digest_model(model)
    for subject in (1, 2):
        for pose in range(0, 40, 4):
            truth = generate_truth(subject, pose)
            made = refuse(Scan(truth.vertices, np.zeros_like(truth.vertices)), model, digest, (), 0.0)
            more = {"subject": f"s{subject}", "pose_name": truth.pose_name, "scan": f"{subject}-{pose}"}
            made = replace(made, vertices=truth.vertices, side="right", verdict="good", **more)
            save_registration(made, tmp_path / "registrations" / more["scan"])
    return tmp_path / "registrations"


@pytest.mark.slow
def test_training_that_is_killed_goes_on_with_the_same_bits(registered, tmp_path):
    words = ("train-model", registered, "--no-pose-shapes", "--rounds-of-training", 2, "--json", "--out")
    undisturbed = start(*words, tmp_path / "one.npz")
    assert undisturbed.wait(240) == 0, undisturbed.communicate()
    killed = start(*words, tmp_path / "two.npz")
    kept = tmp_path / "two.stages"
    wait_for(killed, lambda: (kept / "round-1-joints.npz").exists())
    os.killpg(killed.pid, signal.SIGKILL)
    killed.communicate()
    assert not (tmp_path / "two.npz").exists()
    first = (kept / "first-poses.npz").stat().st_mtime_ns
    again = start(*words, tmp_path / "two.npz")
    wait_for(again, lambda: (tmp_path / "two.npz").exists() or (kept / "round-2.npz").exists())
    assert not kept.exists() or (kept / "first-poses.npz").stat().st_mtime_ns == first
    out, said = again.communicate(timeout=240)
    assert again.returncode == 0, said
    assert (tmp_path / "one.npz").read_bytes() == (tmp_path / "two.npz").read_bytes()
    assert not kept.exists() and json.loads(out)["registrations"] == 20
