"""Jobs that find the hands in a recording's images: whole results, whatever happens in between."""

from __future__ import annotations

import shutil
import uuid
from pathlib import Path

import pytest
from fastapi.testclient import TestClient

from server.app.app import create_app
from server.jobs import service
from server.jobs.detections import AREA, find_detections
from server.jobs.restarting import list_kept
from tests.server.conftest import BASE_URL, AddRecording
from tests.server.jobs.test_worker import Bench, bench, bench_on_both, wait_for_failure
from tracker.detection import load_recorded_hands

__all__ = ["bench", "bench_on_both"]

API = "/api/v1"


def queue(bench: Bench) -> uuid.UUID:
    with bench.database.writing() as session:
        return service.create_job(session, "detect", bench.sequence_id, {}).id


def read(bench: Bench, job_id: uuid.UUID) -> bytes:
    return bench.storage.document(AREA, job_id).read_bytes()


@pytest.mark.slow
def test_a_job_that_fails_at_a_damaged_image_goes_on_there_when_it_is_mended(bench: Bench, tmp_path: Path) -> None:
    undisturbed = queue(bench)
    bench.start_worker()
    job = bench.wait_for_end(undisturbed)
    assert (job.progress, job.frames_done, job.frames_total, job.error) == (1.0, 45, 45, None)
    assert "the right hand was found in 45 of 45 frames" in bench.log(undisturbed)
    found = load_recorded_hands(bench.storage.document(AREA, undisturbed))
    assert found.frames == range(45) and [item.frame for item in found.hands.items] == list(range(45))

    image = sorted((bench.storage.folder("sequences", bench.sequence_id) / "color").iterdir())[30]
    shutil.copy(image, tmp_path / "whole")
    image.write_bytes(b"no image")
    disturbed = queue(bench)
    failed = wait_for_failure(bench, disturbed)
    assert failed.error is not None and image.name in failed.error and "unexpected error" not in failed.error
    assert list_kept(bench.storage, failed) == ["frames 0 to 19"]
    with bench.database.reading() as session:
        assert find_detections(session, bench.sequence_id) == undisturbed, "half a job is not used"
    shutil.copy(tmp_path / "whole", image)
    with bench.database.writing() as session:
        service.resume_job(session, disturbed)
    ended = bench.wait(disturbed, lambda job: job.state == "succeeded")
    assert ended.frames_done == 45
    assert bench.log(disturbed).count("looked at frames 0 to 19") <= 2
    assert read(bench, disturbed) == read(bench, undisturbed)
    with bench.database.reading() as session:
        assert find_detections(session, bench.sequence_id) == disturbed

    with TestClient(create_app(bench.settings), base_url=BASE_URL) as client:
        place = f"{API}/sequences/{bench.sequence_id}/suggestions/cam0/44/detector"
        [suggestion] = client.get(place).json()["items"]
        last = found.at(44, "cam0")[0].points.tolist()
        assert [joint["px"] for joint in suggestion["joints"]] == [[x, y] for x, y, _ in last]


@pytest.mark.slow
@pytest.mark.parametrize("database_kind", ["sqlite", "postgresql"])
def test_a_job_whose_worker_is_killed_ends_with_the_same_bytes(bench_on_both: Bench) -> None:
    bench = bench_on_both
    worker = bench.start_worker()
    undisturbed, disturbed = queue(bench), queue(bench)
    bench.wait_for_end(undisturbed)
    bench.wait(disturbed, lambda job: job.frames_done >= 20)
    bench.kill(worker)
    bench.start_worker()
    bench.wait_for_end(disturbed)
    assert read(bench, disturbed) == read(bench, undisturbed)


def test_a_job_is_queued_for_a_recording_with_colour_and_can_be_cancelled(
    client: TestClient, add_recording: AddRecording
) -> None:
    sequence = add_recording()["id"]
    assert client.post(f"{API}/jobs/detect/check", json={"sequence_id": sequence}).json()["can_start"] is True
    answer = client.post(f"{API}/jobs/detect", json={"sequence_id": sequence})
    assert answer.status_code == 201, answer.text
    job = answer.json()
    assert (job["kind"], job["state"], job["unit"], job["sequence_id"]) == ("detect", "queued", "frames", sequence)
    assert client.get(f"{API}/jobs", params={"kind": "detect"}).json()["items"] == [job]
    assert client.post(f"{API}/jobs/{job['id']}/cancel").json()["state"] == "cancelled"
    assert client.get(f"{API}/jobs/{job['id']}/restart").json()["kept"] == []
    assert client.post(f"{API}/jobs/{job['id']}/resume").json()["state"] == "queued"


def test_depth_alone_is_refused_and_says_why(client: TestClient, add_recording: AddRecording) -> None:
    sequence = add_recording(color=None)["id"]
    answer = client.post(f"{API}/jobs/detect", json={"sequence_id": sequence})
    assert answer.status_code == 422 and "has only depth images" in answer.json()["obstacles"][0]
    check = client.post(f"{API}/jobs/detect/check", json={"sequence_id": sequence}).json()
    assert check["can_start"] is False and check["obstacles"] == answer.json()["obstacles"]
    assert client.post(f"{API}/jobs/detect", json={"sequence_id": str(uuid.uuid4())}).status_code == 404
    assert client.get(f"{API}/jobs").json()["items"] == []
