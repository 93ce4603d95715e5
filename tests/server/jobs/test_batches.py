"""Many jobs at once: all of a batch or none, and each of them found again."""

from __future__ import annotations

import uuid
from datetime import timedelta

import pytest
from fastapi.testclient import TestClient

from server.access.models import LOCAL_ACCOUNT_ID, Account
from server.database import utc_now
from server.jobs import service, workers
from server.jobs.models import JobRow
from tests.server.conftest import AddRecording, Studio

API = "/api/v1"


@pytest.fixture
def sequence_ids(add_recording: AddRecording) -> list[str]:
    return [add_recording(name)["id"] for name in ("left hand waves", "right hand waves", "both hands clap")]


@pytest.fixture
def made(client: TestClient, sequence_ids: list[str]) -> dict:
    answer = client.post(f"{API}/jobs/batch", json={"sequence_ids": sequence_ids, "params": {"iterations": 7}})
    assert answer.status_code == 201, answer.text
    return answer.json()


def change(studio: Studio, job: dict, **values: object) -> None:
    with studio.database.writing() as session:
        row = service.get_job(session, uuid.UUID(job["id"]))
        for name, value in values.items():
            setattr(row, name, value)


def batch(client: TestClient, made: dict) -> dict:
    return client.get(f"{API}/jobs/batches/{made['batch']['id']}").json()


def test_a_batch_is_a_job_for_each_recording_with_the_same_options(
    client: TestClient, made: dict, sequence_ids: list[str]
) -> None:
    assert [job["sequence_id"] for job in made["jobs"]] == sequence_ids
    assert [job["title"] for job in made["jobs"]] == ["left hand waves", "right hand waves", "both hands clap"]
    assert {job["batch_id"] for job in made["jobs"]} == {made["batch"]["id"]}
    assert {job["params"]["iterations"] for job in made["jobs"]} == {7}
    assert {job["created_by_name"] for job in made["jobs"]} == {client.get(f"{API}/account").json()["name"]}
    assert (made["batch"]["total"], made["batch"]["states"]["queued"], made["batch"]["progress"]) == (3, 3, 0)
    listed = client.get(f"{API}/jobs", params={"batch_id": made["batch"]["id"]}).json()["items"]
    assert {job["id"] for job in listed} == {job["id"] for job in made["jobs"]}
    assert client.get(f"{API}/jobs/batches").json()["items"] == [made["batch"]]
    assert client.get(f"{API}/jobs/batches/{uuid.uuid4()}").status_code == 404


def test_of_a_batch_that_cannot_be_started_whole_nothing_is_started(
    client: TestClient, sequence_ids: list[str]
) -> None:
    missing = str(uuid.uuid4())
    answer = client.post(f"{API}/jobs/batch", json={"sequence_ids": [*sequence_ids, missing]})
    assert answer.status_code == 422
    assert "1 of 4 recordings" in answer.json()["detail"]
    assert "no job was started" in answer.json()["detail"]
    assert [item["id"] for item in answer.json()["refused"]] == [missing]
    wrong = client.post(f"{API}/jobs/batch", json={"sequence_ids": sequence_ids, "params": {"iterations": 0}})
    assert wrong.status_code == 422
    assert [item["id"] for item in wrong.json()["refused"]] == sequence_ids
    assert client.get(f"{API}/jobs").json()["items"] == []
    for ids in ([], [sequence_ids[0]] * 501, ["x"]):
        assert client.post(f"{API}/jobs/batch", json={"sequence_ids": ids}).status_code == 422


def test_a_recording_named_twice_is_tracked_once(client: TestClient, sequence_ids: list[str]) -> None:
    body = {"sequence_ids": [sequence_ids[0], sequence_ids[1], sequence_ids[0]]}
    assert client.post(f"{API}/jobs/batch", json=body).json()["batch"]["total"] == 2


def test_the_progress_and_the_rest_of_a_batch_are_those_of_its_jobs(
    client: TestClient, studio: Studio, made: dict
) -> None:
    first, second, _ = made["jobs"]
    began = utc_now()
    assert batch(client, made)["seconds_left"] is None
    change(studio, first, state="succeeded", progress=1.0, started_at=began, ended_at=began + timedelta(seconds=60))
    change(studio, second, state="running", progress=0.5, seconds_left=25.0)
    found = batch(client, made)
    assert found["progress"] == pytest.approx(0.5)
    assert found["seconds_left"] == pytest.approx(25.0 + 60.0), "what runs, then one more as long as the first"
    assert found["states"] == {"queued": 1, "running": 1, "succeeded": 1, "failed": 0, "cancelled": 0}
    assert found["ended_at"] is None


def test_a_job_tried_again_takes_the_place_of_the_one_that_failed(
    client: TestClient, studio: Studio, made: dict
) -> None:
    first = made["jobs"][0]
    change(studio, first, state="failed", ended_at=utc_now())
    again = client.post(f"{API}/jobs/{first['id']}/retry").json()
    assert again["batch_id"] == made["batch"]["id"]
    assert (batch(client, made)["total"], batch(client, made)["states"]["failed"]) == (3, 0)


def test_what_is_done_to_many_is_done_to_each_by_itself_and_said(
    client: TestClient, studio: Studio, made: dict
) -> None:
    done, waiting, running = made["jobs"]
    change(studio, done, state="succeeded", ended_at=utc_now())
    change(studio, running, state="running")
    missing = str(uuid.uuid4())
    body = {"act": "cancel", "job_ids": [done["id"], waiting["id"], running["id"], missing]}
    answer = client.post(f"{API}/jobs/bulk", json=body).json()
    assert [(job["id"], job["state"]) for job in answer["jobs"]] == [
        (waiting["id"], "cancelled"),
        (running["id"], "cancelled"),
    ]
    assert [item["id"] for item in answer["refused"]] == [done["id"], missing]
    assert "has succeeded" in answer["refused"][0]["detail"]
    assert batch(client, made)["ended_at"] is not None
    resumed = client.post(f"{API}/jobs/bulk", json={"act": "resume", "job_ids": [waiting["id"]]}).json()
    assert resumed["jobs"][0]["attempt"] == 2
    retried = client.post(f"{API}/jobs/bulk", json={"act": "retry", "job_ids": [running["id"]]}).json()
    assert retried["jobs"][0]["retry_of"] == running["id"]
    assert client.post(f"{API}/jobs/bulk", json={"act": "destroy", "job_ids": [missing]}).status_code == 422


def test_jobs_are_found_by_state_person_and_words_of_the_recording(
    client: TestClient, studio: Studio, made: dict
) -> None:
    def names(**params: object) -> list[str]:
        items = client.get(f"{API}/jobs", params=params).json()["items"]
        return sorted(job["title"] for job in items)

    somebody = uuid.uuid4()
    with studio.database.writing() as session:
        session.add(Account(id=somebody, name="Ada", role="lead"))
    change(studio, made["jobs"][2], created_by=somebody, state="running")
    assert names(created_by=str(somebody)) == ["both hands clap"]
    assert names(created_by=str(LOCAL_ACCOUNT_ID)) == ["left hand waves", "right hand waves"]
    assert names(search="WAVES left") == ["left hand waves"]
    assert names(search="100%_") == []
    assert names(state=["running", "failed"]) == ["both hands clap"]
    assert len(names(state=["running", "queued"])) == 3


def test_batches_come_in_pages_newest_first_and_none_twice(client: TestClient, sequence_ids: list[str]) -> None:
    ids = [
        client.post(f"{API}/jobs/batch", json={"sequence_ids": sequence_ids[:2]}).json()["batch"]["id"]
        for _ in range(5)
    ]
    client.post(f"{API}/jobs", json={"sequence_id": sequence_ids[0]})
    seen, cursor = [], None
    while True:
        page = client.get(f"{API}/jobs/batches", params={"limit": 2, **({"cursor": cursor} if cursor else {})}).json()
        seen += [item["id"] for item in page["items"]]
        if (cursor := page["next_cursor"]) is None:
            break
    assert seen == ids[::-1]


def test_a_job_says_who_runs_it_and_where(client: TestClient, studio: Studio, made: dict) -> None:
    job_id = uuid.UUID(made["jobs"][0]["id"])
    with studio.database.writing() as session:
        worker = workers.register_worker(session, "desk-0")
        worker_id, host = worker.id, worker.host
        service.claim_job(session, job_id, 1, worker_id)
    job = client.get(f"{API}/jobs/{job_id}").json()
    assert job["worker"] == {"id": str(worker_id), "name": "desk-0", "host": host}
    with studio.database.reading() as session:
        assert session.get_one(JobRow, job_id).created_by == LOCAL_ACCOUNT_ID
