"""Jobs over REST."""

from __future__ import annotations

import threading
import uuid

import pytest
from fastapi.testclient import TestClient

from server.jobs import service, workers
from tests.server.conftest import AddRecording, Studio

API = "/api/v1"


@pytest.fixture
def sequence_id(add_recording: AddRecording) -> str:
    return add_recording()["id"]


@pytest.fixture
def job(client: TestClient, sequence_id: str) -> dict:
    answer = client.post(f"{API}/jobs", json={"sequence_id": sequence_id, "params": {"iterations": 7}})
    assert answer.status_code == 201, answer.text
    return answer.json()


def test_a_job_is_queued_with_all_options_spelled_out(client: TestClient, job: dict) -> None:
    assert (job["state"], job["kind"], job["progress"], job["frames_done"]) == ("queued", "track", 0, 0)
    assert job["params"]["iterations"] == 7
    assert job["params"]["first_iterations"] == 50
    assert client.get(f"{API}/jobs/{job['id']}").json() == job
    assert client.get(f"{API}/jobs", params={"sequence_id": job["sequence_id"]}).json()["items"] == [job]
    assert client.get(f"{API}/jobs", params={"state": "failed"}).json() == {"items": [], "next_cursor": None}


@pytest.mark.parametrize(
    ("params", "said"),
    [
        ({"iterations": 0}, "iterations is 0"),
        ({"iteration": 5}, "There is no option 'iteration'"),
        ({"calibrate": "yes"}, "calibrate is 'yes'"),
        ({"first_frame": 9, "last_frame": 3}, "comes before"),
    ],
)
def test_options_that_make_no_sense_are_refused_before_anything_is_queued(
    client: TestClient, sequence_id: str, params: dict, said: str
) -> None:
    answer = client.post(f"{API}/jobs", json={"sequence_id": sequence_id, "params": params})
    assert answer.status_code == 422
    assert said in answer.json()["detail"]
    assert client.get(f"{API}/jobs").json()["items"] == []


def test_a_job_needs_a_recording_that_is_there(client: TestClient) -> None:
    assert client.post(f"{API}/jobs", json={"sequence_id": str(uuid.uuid4())}).status_code == 404


def test_cancel_retry_and_resume(client: TestClient, job: dict) -> None:
    address = f"{API}/jobs/{job['id']}"
    assert client.post(f"{address}/retry").status_code == 409
    assert client.post(f"{address}/resume").status_code == 409
    assert client.post(f"{address}/cancel").json()["state"] == "cancelled"
    again = client.post(f"{address}/retry")
    assert again.status_code == 201
    assert again.json()["params"] == job["params"]
    resumed = client.post(f"{address}/resume").json()
    assert (resumed["state"], resumed["attempt"]) == ("queued", 2)
    texts = [line["text"] for line in client.get(f"{address}/log").json()["lines"]]
    assert texts == ["queued", "cancelled", "queued to be resumed"]
    assert [line["n"] for line in client.get(f"{address}/log", params={"after": 2}).json()["lines"]] == [3]
    for act in ("cancel", "retry", "resume"):
        assert client.post(f"{API}/jobs/{uuid.uuid4()}/{act}").status_code == 404


def test_the_event_stream_ends_with_the_job_and_tells_a_browser_that_comes_back_to_stop(
    client: TestClient, studio: Studio, job: dict
) -> None:
    def cancel() -> None:
        with studio.database.writing() as session:
            service.cancel_job(session, uuid.UUID(job["id"]))

    timer = threading.Timer(0.6, cancel)
    timer.start()
    answer = client.get(f"{API}/jobs/{job['id']}/events")
    timer.join()
    assert answer.headers["content-type"].startswith("text/event-stream")
    events = [block for block in answer.text.split("\n\n") if block.startswith("event: ")]
    assert '"state":"queued"' in events[1]
    assert '"state":"cancelled"' in events[-2]
    assert events[-1].startswith("event: end")
    last_id = next(line for line in events[-2].splitlines() if line.startswith("id: "))[4:]
    heard_all = client.get(f"{API}/jobs/{job['id']}/events", headers={"Last-Event-ID": last_id})
    assert heard_all.status_code == 204
    assert client.get(f"{API}/jobs/{uuid.uuid4()}/events").status_code == 404


def test_an_open_event_stream_ends_when_the_studio_stops(client: TestClient, studio: Studio, job: dict) -> None:
    timer = threading.Timer(0.6, lambda: setattr(studio.app.state, "is_stopping", True))
    timer.start()
    answer = client.get(f"{API}/jobs/events")
    timer.join()
    assert f'"id":"{job["id"]}"' in answer.text


def test_the_form_lists_every_option_with_type_default_and_help(client: TestClient) -> None:
    form = client.get(f"{API}/jobs/form").json()
    fields = {field["name"]: field for field in form["fields"]}
    assert fields["iterations"]["type"] == "integer"
    assert fields["iterations"]["default"] == 10
    assert fields["calibrate"]["type"] == "boolean"
    assert fields["stop_below_mm"]["type"] == "number"
    assert all(field["help"].endswith(".") for field in fields.values())
    assert (fields["threads"]["low"], fields["threads"]["high"], fields["threads"]["is_advanced"]) == (1, 64, True)
    assert len(fields["terms"]["choices"]) == len(fields["terms"]["choice_labels"])


def test_a_job_takes_the_values_of_every_preset_that_the_form_offers(client: TestClient, add_recording) -> None:
    form = client.get(f"{API}/jobs/form").json()
    names = [preset["name"] for preset in form["presets"]]
    assert form["usual_preset"] in names
    costs = [preset["two_hands_and_object_ms"] for preset in form["presets"]]
    assert costs == sorted(costs), "from the quickest to the most thorough"
    sequence_id = add_recording()["id"]
    for preset in form["presets"]:
        body = {"kind": "track", "sequence_id": sequence_id, "params": preset["values"]}
        job = client.post(f"{API}/jobs", json=body)
        assert job.status_code == 201, job.text
        assert preset["values"].items() <= job.json()["params"].items()


def test_workers_are_listed_with_what_they_do(client: TestClient, studio: Studio, job: dict) -> None:
    assert client.get(f"{API}/workers").json()["items"] == []
    with studio.database.writing() as session:
        worker_id = workers.register_worker(session, "desk-0").id
        service.claim_job(session, uuid.UUID(job["id"]), 1, worker_id)
    (worker,) = client.get(f"{API}/workers").json()["items"]
    assert (worker["name"], worker["state"], worker["job_id"]) == ("desk-0", "running", job["id"])
