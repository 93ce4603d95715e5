"""The examples run as they stand."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def run(script: str, *arguments: Path) -> str:
    """What an example prints; it must not fail."""
    command = [sys.executable, f"examples/{script}", *map(str, arguments)]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def recording(tmp_path_factory) -> Path:
    from tracker.cli.__main__ import main

    out = tmp_path_factory.mktemp("recordings") / "wave"
    assert main(["synthesize", "--motion", "wave", "--frames", "0:8", "--out", str(out)]) == 0
    return out


def test_a_recording_is_tracked_and_its_track_read(recording, tmp_path):
    assert "8 frames in" in run("01_track_a_recording.py", recording, tmp_path / "track")
    assert "8 frames, 0 lost" in run("03_read_a_track.py", tmp_path / "track")


def test_a_rendered_hand_is_tracked_and_compared_with_the_truth():
    assert "lost frames: 0" in run("02_render_a_twin.py")
