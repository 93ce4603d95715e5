"""Jobs that calibrate cameras: what they find is what is true, and a job that was stopped goes on where it was."""

from __future__ import annotations

import io
import uuid
import zipfile
from typing import Any

import cv2
import numpy as np
import pytest
from fastapi.testclient import TestClient

from server.app.app import create_app
from server.jobs.restarting import list_kept
from tests.server.calibrations.films import OFFSET_S, filmed, make_form, render_films
from tests.server.conftest import BASE_URL
from tests.server.jobs.scan_bench import ScanBench, bench
from tests.server.jobs.test_worker import wait_for_failure
from tracker.capture.anipose_calibration import parse_anipose

__all__ = ["bench"]

API = "/api/v1"


@pytest.fixture
def client(bench: ScanBench):
    with TestClient(create_app(bench.settings), base_url=BASE_URL) as opened:
        yield opened


def send(client: TestClient, files: dict[str, bytes], **options: Any) -> str:
    answer = client.post(f"{API}/calibrations", **make_form(files, **options))
    assert answer.status_code == 201 and answer.json()["state"] == "checked", answer.text
    return answer.json()["id"]


def start(client: TestClient, calibration: str) -> uuid.UUID:
    answer = client.post(f"{API}/jobs/calibrate", json={"calibration_id": calibration})
    assert answer.status_code == 201, answer.text
    return uuid.UUID(answer.json()["id"])


@pytest.mark.slow
def test_films_become_cameras_with_a_report_and_files_and_an_import_takes_them(
    bench: ScanBench, client: TestClient
) -> None:
    calibration = send(client, render_films())
    sent = send_import(client)
    too_early = client.put(f"{API}/imports/{sent['id']}/calibration", json={"calibration_id": calibration})
    assert too_early.status_code == 404 and "not calibrated yet" in too_early.json()["detail"]
    assert client.get(f"{API}/imports/{sent['id']}").json() == sent
    job_id = start(client, calibration)
    again = client.post(f"{API}/jobs/calibrate", json={"calibration_id": calibration})
    assert again.status_code == 422 and "being calibrated already" in again.json()["detail"]
    bench.start_worker()
    bench.wait_for_end(job_id)
    job = client.get(f"{API}/jobs/{job_id}").json()
    assert (job["title"], job["unit"], job["frames_done"], job["frames_total"]) == ("Rig", "cameras", 2, 2)
    assert any(line.startswith("cam0: the board was found in ") for line in bench.log(job_id))
    assert client.get(f"{API}/calibrations/{calibration}").json()["job_id"] == str(job_id)
    check_result(client, calibration)
    check_what_follows(client, calibration)
    take_into_import(client, calibration, sent["id"])


def send_import(client: TestClient) -> dict[str, Any]:
    """The same films as a recording, which lacks a calibration."""
    sent = client.post(f"{API}/imports", files=[("files", film) for film in render_films().items()]).json()
    assert sent["state"] == "refused" and sent["calibration_id"] is None
    assert "2 videos and no calibration" in sent["report"]["problems"][0]
    return sent


def check_result(client: TestClient, calibration: str) -> None:
    place = f"{API}/calibrations/{calibration}"
    result = client.get(place).json()["result"]
    second = result["cameras"][1]
    assert abs(second["time_offset"]["seconds"] - OFFSET_S) < 0.01
    assert result["residual_px"]["left_out"]["rms"] < 0.6
    assert any("cam1: is out of step" in warning for warning in result["warnings"])
    found = parse_anipose(client.get(f"{place}/files/cameras.toml").content, "cameras.toml")
    truth = np.linalg.norm(filmed().cameras[1].T_world_camera[:3, 3])
    assert np.linalg.norm(found[1].find_pose(1.0)[:3, 3]) == pytest.approx(truth, rel=0.05)
    report = client.get(f"{place}/files/report.json").json()
    assert report["cameras"] == result["cameras"] and len(report["boards"]) > 10
    with zipfile.ZipFile(io.BytesIO(client.get(f"{place}/files/colmap.zip").content)) as archive:
        assert archive.namelist() == ["cameras.txt", "images.txt", "points3D.txt"]
    assert set(result["files"]) >= {"cameras.yaml", "report.txt", "board.toml"}
    for number in range(2):
        picture = client.get(f"{place}/coverage/{number}.png").content
        assert cv2.imdecode(np.frombuffer(picture, np.uint8), cv2.IMREAD_COLOR).shape[1] == 960
    assert client.get(f"{place}/coverage/2.png").status_code == 404


def check_what_follows(client: TestClient, calibration: str) -> None:
    """It is not calibrated twice, and other options make another one."""
    place = f"{API}/calibrations/{calibration}"
    done = client.get(place).json()
    refused = client.post(f"{API}/jobs/calibrate", json={"calibration_id": calibration})
    assert refused.status_code == 422 and "calibrated already" in refused.json()["detail"]
    other = client.post(f"{place}/check", json={"options": {**done["options"], "left_out": 0.3}}).json()
    assert other["id"] != calibration and other["result"] is None and other["state"] == "checked"
    assert client.get(place).json() == done, "what has a result stays"


def take_into_import(client: TestClient, calibration: str, import_id: str) -> None:
    place = f"{API}/imports/{import_id}"
    taken = client.put(f"{place}/calibration", json={"calibration_id": calibration}).json()
    assert (taken["state"], taken["calibration_id"]) == ("checked", calibration), taken["report"]
    assert taken["report"]["format"] == "synced_videos"
    given_up = client.put(f"{place}/calibration", json={"calibration_id": None}).json()
    assert (given_up["state"], given_up["calibration_id"]) == ("refused", None)
    client.put(f"{place}/calibration", json={"calibration_id": calibration})
    recording = client.post(f"{place}/confirm", json={"name": "hands"}).json()
    cameras = client.get(f"{API}/sequences/{recording['id']}").json()["cameras"]
    found = parse_anipose(client.get(f"{API}/calibrations/{calibration}/files/cameras.toml").content, "c.toml")
    for camera, own in zip(cameras, found, strict=True):
        assert camera["id"] == own.name
        np.testing.assert_allclose(camera["K"], own.K)
        np.testing.assert_allclose(camera["T_world_camera"], own.find_pose(1.0), atol=1e-9)
    late = client.put(f"{place}/calibration", json={"calibration_id": None})
    assert late.status_code == 409


@pytest.mark.slow
def test_a_wrong_board_fails_in_words_and_the_right_one_is_found_in_the_same_films(
    bench: ScanBench, client: TestClient
) -> None:
    wrong = {"kind": "charuco", "columns": 5, "rows": 7, "square_mm": 30.0, "marker_mm": 22.5}
    calibration = send(client, render_films(), board={**wrong, "dictionary": "DICT_6X6_250"})
    job_id = start(client, calibration)
    bench.start_worker()
    failed = wait_for_failure(bench, job_id)
    assert failed.error is not None and failed.error.startswith("cam0: the board (ChArUco 5x7")
    assert "Markers of DICT_4X4" in failed.error and str(bench.settings.data_dir) not in failed.error
    right = make_form({})["data"]["options"]
    place = f"{API}/calibrations/{calibration}"
    checked = client.post(
        f"{place}/check", content=f'{{"options": {right}}}', headers={"Content-Type": "application/json"}
    )
    assert checked.json()["id"] == calibration
    bench.wait_for_end(start(client, calibration))
    assert client.get(place).json()["result"]["residual_px"]["left_out"]["rms"] < 0.6


@pytest.mark.slow
def test_a_cancelled_job_goes_on_with_the_corners_it_has(bench: ScanBench, client: TestClient) -> None:
    calibration = send(client, render_films())
    job_id = start(client, calibration)
    bench.start_worker()
    bench.wait_for_file(job_id, "corners-0000.json")
    bench.cancel(job_id)
    assert client.get(f"{API}/jobs/{job_id}").json()["state"] == "cancelled"
    [kept] = list_kept(bench.storage, bench.job(job_id))
    assert kept.startswith("where the board was seen in ")
    check = client.get(f"{API}/jobs/{job_id}/restart").json()
    assert check["resume"]["can_start"] and check["kept"] == [kept]
    before = (bench.storage.folder("jobs", job_id) / "corners-0000.npz").stat().st_mtime_ns
    assert client.post(f"{API}/jobs/{job_id}/resume").status_code == 200
    bench.wait(job_id, lambda job: job.progress > 0.5)
    path = bench.storage.folder("jobs", job_id) / "corners-0000.npz"
    assert not path.exists() or path.stat().st_mtime_ns == before, "it is not looked for again"
    bench.wait_for_end(job_id)
    assert sum(line.startswith("cam0: the board was found") for line in bench.log(job_id)) == 1
    retry = client.post(f"{API}/jobs/{job_id}/retry")
    assert retry.status_code == 422 and "calibrated already" in retry.json()["detail"]
