"""What cannot be done is told before it is tried: the answer to a form and to the request are the same."""

from __future__ import annotations

import uuid
from typing import Any

import pytest
from fastapi.testclient import TestClient
from sqlalchemy import select

from server.access.models import LOCAL_ACCOUNT_ID
from server.registrations.decision_schemas import DecisionMake
from server.registrations.decisions import decide
from server.registrations.models import RegistrationRow
from tests.server.conftest import AddRecording, GeneratedHand, Studio
from tests.server.curation import add_registered

API = "/api/v1"
NO_WORKER = "No worker is running: the job waits until one is started with “handloom worker”."


def refused(client: TestClient, path: str, body: dict[str, Any]) -> str:
    """Why a job cannot be started; the check and the request say the same, and nothing is stored."""
    jobs, sets = client.get(f"{API}/jobs").json(), client.get(f"{API}/training-sets").json()
    checked = client.post(f"{API}/jobs{path}/check", json=body)
    assert checked.status_code == 200, checked.text
    answer = client.post(f"{API}/jobs{path}", json=body)
    assert answer.status_code in (404, 422), answer.text
    obstacles = checked.json()["obstacles"]
    assert not checked.json()["can_start"] and obstacles
    assert answer.json()["detail"] == " ".join(obstacles)
    assert (client.get(f"{API}/jobs").json(), client.get(f"{API}/training-sets").json()) == (jobs, sets)
    return answer.json()["detail"]


def may_start(client: TestClient, path: str, body: dict[str, Any]) -> None:
    checked = client.post(f"{API}/jobs{path}/check", json=body).json()
    assert (checked["can_start"], checked["obstacles"]) == (True, []), checked
    answer = client.post(f"{API}/jobs{path}", json=body)
    assert answer.status_code == 201, answer.text


def test_a_recording_that_cannot_be_tracked_is_not_queued(client: TestClient, add_recording: AddRecording) -> None:
    flat = add_recording("colour only", depth=False)
    deep = add_recording("with depth")
    for recording, params, told in (
        (flat, {"use_detector": False}, "In colour images only the hand detector finds hands"),
        (flat, {"cameras": "cam0,cam9"}, "cam9 is no camera with colour images of this recording. Choose among cam0."),
        (deep, {"camera": "cam7"}, "Camera cam7 has no depth images. Choose cam0."),
        (deep, {"last_frame": 999}, f"the recording has 0 to {deep['frame_count'] - 1}"),
        (deep, {"first_frame": 5, "last_frame": 3}, "The last frame, 3, comes before the first, 5."),
        (deep, {"iterations": 0}, "needed a number from 1 to 200"),
        (deep, {"hand_model_id": str(uuid.uuid4())}, "There is no hand model"),
        ({"id": str(uuid.uuid4())}, {}, "does not exist"),
    ):
        assert told in refused(client, "", {"sequence_id": recording["id"], "params": params})
    may_start(client, "", {"sequence_id": flat["id"]})
    ids = [flat["id"], deep["id"]]
    params = {"use_detector": False}
    found = client.post(f"{API}/jobs/batch/check", json={"sequence_ids": ids, "params": params}).json()["refused"]
    assert [one["id"] for one in found] == [flat["id"]] and "only the hand detector" in found[0]["detail"]
    may_start(client, "", {"sequence_id": deep["id"]})


def test_who_asks_hears_that_nobody_is_there_to_do_it(client: TestClient, add_recording: AddRecording) -> None:
    body = {"sequence_id": add_recording("with depth")["id"]}
    assert client.post(f"{API}/jobs/check", json=body).json()["notes"] == [NO_WORKER]


def test_what_is_gone_meanwhile_keeps_a_job_from_being_tried_again(
    client: TestClient, add_recording: AddRecording
) -> None:
    recording = add_recording("with depth")
    job = client.post(f"{API}/jobs", json={"sequence_id": recording["id"]}).json()
    client.post(f"{API}/jobs/{job['id']}/cancel")
    found = client.get(f"{API}/jobs/{job['id']}/restart").json()
    assert (found["retry"]["can_start"], found["resume"]["can_start"], found["kept"]) == (True, True, [])
    revision = client.get(f"{API}/sequences/{recording['id']}").headers["etag"]
    assert client.delete(f"{API}/sequences/{recording['id']}", headers={"If-Match": revision}).status_code < 300
    found = client.get(f"{API}/jobs/{job['id']}/restart").json()
    assert "was deleted" in found["retry"]["obstacles"][0]
    for act in ("retry", "resume"):
        answer = client.post(f"{API}/jobs/{job['id']}/{act}")
        assert answer.status_code == 422 and "was deleted" in answer.json()["detail"]
    done = client.post(f"{API}/jobs/bulk", json={"act": "retry", "job_ids": [job["id"]]}).json()
    assert "was deleted" in done["refused"][0]["detail"]


def test_registering_needs_scans_that_are_not_done(
    client: TestClient, studio: Studio, generated_hand: GeneratedHand
) -> None:
    assert "There is no scan to register. Add scans first" in refused(client, "/register", {})
    add_registered(studio.app, generated_hand, "one", collection="x")
    assert "has registered the one scan of x as cropped now" in refused(client, "/register", {"collection": "x"})
    accept(studio)
    body = {"only": "not_accepted"}
    assert "Somebody has accepted the newest registration of the one scan" in refused(client, "/register", body)
    assert "There is no hand model" in refused(client, "/register", {"model_id": str(uuid.uuid4())})
    may_start(client, "/register", {"only": "all", "collection": "x"})


def accept(studio: Studio) -> None:
    """Accept every registration about which nobody has decided."""
    with studio.database.writing() as session:
        for row in session.scalars(select(RegistrationRow).where(RegistrationRow.reviewer_count == 0)).all():
            made = DecisionMake(decision="accept", operation_id=uuid.uuid4())
            decide(session, row.id, LOCAL_ACCOUNT_ID, made)


@pytest.mark.parametrize("path", ["", "/register", "/train", "/loop", "/batch"])
def test_a_check_is_refused_as_the_request_is_where_it_makes_no_sense(client: TestClient, path: str) -> None:
    assert client.post(f"{API}/jobs{path}/check", json={"nonsense": [1]}).status_code == (
        client.post(f"{API}/jobs{path}", json={"nonsense": [1]}).status_code
    )
