"""Without pybullet, as on Python 3.12 and newer: everything but the physics term works, and one line says so."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import httpx
import pytest

from tests.server.cli.test_cli import ROOT
from tracker import load_track

pytestmark = pytest.mark.slow

REASON = "The physics term (P) needs pybullet, which is not installed for this Python"


@pytest.fixture
def variables(tmp_path: Path) -> dict[str, str]:
    """Of a process, and of those that it starts, in which `import pybullet` fails."""
    blocked = tmp_path / "blocked"
    blocked.mkdir()
    (blocked / "sitecustomize.py").write_text("import sys\nsys.modules['pybullet'] = None\n")
    path = os.pathsep.join([str(blocked), str(ROOT)])
    return {**os.environ, "HANDLOOM_DATA_DIR": str(tmp_path / "data"), "PYTHONPATH": path}


def handloom(variables: dict[str, str], *arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "server.cli", *arguments]
    return subprocess.run(command, capture_output=True, text=True, env=variables, timeout=300)


def test_a_recording_is_tracked_and_with_physics_it_is_refused_in_one_line(
    variables: dict[str, str], rendered: Path, tmp_path: Path
) -> None:
    out = tmp_path / "track"
    command = ["track", str(rendered), "--out", str(out), "--frames", "0:3"]
    refused = handloom(variables, *command, "--terms", "LO+SCP")
    assert refused.returncode == 2
    [line] = refused.stderr.splitlines()
    assert REASON in line
    assert not out.exists()
    done = handloom(variables, *command, "--terms", "LO+SC")
    assert done.returncode == 0, done.stderr
    assert list(load_track(out).status) == ["ok"] * 3


@pytest.mark.slow
def test_kernels_are_compiled_and_the_measurement_with_physics_is_left_out(variables: dict[str, str]) -> None:
    assert handloom(variables, "warm-up").returncode == 0
    measured = handloom(variables, "bench", "tracking", "--case", "two_hands_object_physics", "--json")
    assert (measured.returncode, json.loads(measured.stdout)) == (0, {})
    assert measured.stderr.startswith(f"bench: two_hands_object_physics is left out. {REASON}")


def test_the_studio_starts_says_so_and_offers_every_term_but_physics(variables: dict[str, str], rendered: Path) -> None:
    assert handloom(variables, "import", str(rendered)).returncode == 0
    command = [sys.executable, "-m", "server.cli", "serve", "--no-worker", "--port", "0"]
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=variables, start_new_session=True
    ) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        try:
            address = process.stdout.readline().split()[3]
            with httpx.Client(base_url=f"{address}/api/v1/", timeout=60.0) as client:
                form = client.get("jobs/form").json()
                [recording] = client.get("sequences").json()["items"]
                body = {"kind": "track", "sequence_id": recording["id"], "params": {"terms": "LO+SCP"}}
                refused = client.post("jobs", json=body)
                taken = client.post("jobs", json=body | {"params": {}})
        finally:
            process.terminate()
            said = process.stderr.read()
    [terms] = [field for field in form["fields"] if field["name"] == "terms"]
    assert terms["choices"] == ["LO", "LO+C", "LO+S", "LO+SC"]
    assert len(terms["choice_labels"]) == 4
    assert REASON in terms["help"]
    assert [preset["name"] for preset in form["presets"]] == ["fast", "balanced"]
    assert refused.status_code in (409, 422)
    assert REASON in refused.json()["detail"]
    assert taken.status_code == 201
    assert len([line for line in said.splitlines() if REASON in line]) == 1
