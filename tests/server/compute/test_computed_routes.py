"""What routes have computed in the process is what they compute by themselves."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from fastapi.testclient import TestClient

from tests.server.compute import work
from tests.server.conftest import Studio, Tracked
from tests.server.curation import make_ball, send_scans
from tracker.capture.scan import save_scan

API = "/api/v1"


@pytest.fixture
def database_kind() -> str:
    """One will do: how answers travel has nothing to do with the database."""
    return "sqlite"


def ask_all(client: TestClient, paths: list[str]) -> dict[str, bytes]:
    answers = {path: client.get(f"{API}{path}") for path in paths}
    assert {path: answer.status_code for path, answer in answers.items()} == dict.fromkeys(paths, 200)
    return {path: answer.content for path, answer in answers.items()}


def start(studio: Studio) -> Any:
    compute = studio.app.state.compute
    compute.start(work.count)
    return compute


def test_tracks_are_judged_and_exported_there(studio: Studio, client: TestClient, tracked: Tracked) -> None:
    track, recording = f"/tracks/{tracked.track_id}", f"/sequences/{tracked.sequence_id}"
    paths = [
        f"{track}/evaluation",
        f"{track}/evaluation/now-45/cam0/0/right.jpg",
        f"/evaluations/report.csv?track={tracked.track_id}",
        f"{track}/export/csv",
        f"{recording}/labels/export?format=coco_keypoints",
    ]
    here = ask_all(client, paths)
    compute = start(studio)
    assert compute.ask(work.count_verdicts) == 0
    assert ask_all(client, paths) == here
    assert compute.ask(work.count_verdicts) == 1
    views = {"views": [{"camera": "cam0", "points": [[float(n), 5.0, 2] for n in range(21)]}]}
    assert client.post(f"{API}{recording}/triangulation", json=views).status_code == 200
    views["views"][0]["camera"] = "cam9"
    refused = client.post(f"{API}{recording}/triangulation", json=views)
    assert refused.status_code == 422 and "has no camera 'cam9'" in refused.json()["detail"]


def test_scans_are_packed_and_drawn_there(studio: Studio, client: TestClient, tmp_path: Path) -> None:
    save_scan(make_ball(), tmp_path / "ball.ply")
    scan = send_scans(studio, {"ball.ply": (tmp_path / "ball.ply").read_bytes()}).json()["added"][0]
    address = f"/scans/{scan['id']}"
    paths = [f"{address}/geometry/{scan['geometry_key']}", f"{address}/thumbnail/{scan['geometry_key']}.png"]
    here = ask_all(client, paths)
    compute = start(studio)
    assert compute.ask(work.count_scans) == 0
    assert ask_all(client, paths) == here
    assert compute.ask(work.count_scans) == 1
    crop = {"strokes": [], "drops_objects": False}
    assert client.put(f"{API}{address}/crop", json=crop, headers={"If-Match": '"1"'}).status_code == 200
    unit = client.put(f"{API}{address}/unit", json={"metres_per_unit": 1e6}, headers={"If-Match": '"2"'})
    assert unit.status_code == 422 and client.get(f"{API}{address}").json()["revision"] == 2
