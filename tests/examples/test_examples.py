"""The examples run as they stand."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest

ROOT = Path(__file__).resolve().parents[2]


def run(script: str, *arguments: Path | str) -> str:
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


@pytest.mark.slow
def test_a_recording_is_tracked_and_its_track_read(recording, tmp_path):
    assert "8 frames in" in run("01_track_a_recording.py", recording, tmp_path / "track")
    assert "8 frames, 0 lost" in run("03_read_a_track.py", tmp_path / "track")


@pytest.mark.slow
def test_a_rendered_hand_is_tracked_and_compared_with_the_truth():
    assert "lost frames: 0" in run("02_render_a_twin.py")


@pytest.fixture(scope="module")
def studio(recording, tmp_path_factory) -> Iterator[str]:
    """Address of a served studio with its worker and one recording."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    folder = tmp_path_factory.mktemp("studio")
    environment = {**os.environ, "HANDLOOM_DATA_DIR": str(folder / "data")}
    command = [sys.executable, "-m", "server.cli"]
    imported = [*command, "import", str(recording)]
    subprocess.run(imported, cwd=ROOT, env=environment, check=True, capture_output=True, timeout=120)
    with (folder / "log").open("w") as log:
        served = [*command, "serve", "--port", str(port)]
        process = subprocess.Popen(served, cwd=ROOT, env=environment, stdout=log, stderr=subprocess.STDOUT)
    try:
        url, ends = f"http://127.0.0.1:{port}", time.monotonic() + 90
        while time.monotonic() < ends and process.poll() is None:
            try:
                if httpx.get(f"{url}/api/v1/health", timeout=5).is_success:
                    break
            except httpx.HTTPError:
                time.sleep(0.2)
        yield url
    finally:
        process.terminate()
        process.wait(30)


@pytest.mark.slow
def test_a_studio_is_driven_by_scripts(studio, tmp_path):
    said = run("04_track_in_a_studio.py", studio, tmp_path)
    assert "8 frames in" in said
    [folder] = tmp_path.iterdir()
    assert "8 frames, 0 lost" in run("03_read_a_track.py", folder)
    assert "revision 2: the wrist is at" in run("05_correct_an_annotation.py", studio, folder.name)
