"""One request for jobs of every kind: the body's `kind` says which, and the requests before it answer alike."""

from __future__ import annotations

import uuid
from typing import Any

import pytest
from fastapi.testclient import TestClient

from tests.server.conftest import AddRecording

API = "/api/v1"
NOBODY = str(uuid.uuid4())

BODIES: dict[str, dict[str, Any]] = {
    "detect": {"sequence_id": NOBODY},
    "register": {"scan_ids": [NOBODY]},
    "train": {"training_set_id": NOBODY, "name": "Our hand"},
    "loop": {"name": "Our hand"},
    "calibrate": {"calibration_id": NOBODY},
}


@pytest.mark.parametrize("kind", BODIES)
def test_what_cannot_be_done_is_refused_as_the_old_request_refuses_it(client: TestClient, kind: str) -> None:
    body = BODIES[kind]
    new = client.post(f"{API}/jobs", json={"kind": kind, **body})
    old = client.post(f"{API}/jobs/{kind}", json=body)
    assert new.status_code == old.status_code and new.status_code in (404, 422)
    assert new.json() == old.json() and new.json()["detail"]
    checks = (f"{API}/jobs/check", {"kind": kind, **body}), (f"{API}/jobs/{kind}/check", body)
    new_check, old_check = (client.post(path, json=asked) for path, asked in checks)
    assert new_check.status_code == old_check.status_code and new_check.json() == old_check.json()
    assert client.get(f"{API}/jobs").json()["items"] == []


def test_a_job_of_each_kind_for_a_recording_is_queued_as_that_kind(
    client: TestClient, add_recording: AddRecording
) -> None:
    recording = add_recording()["id"]
    told: dict[str, Any] = {"sequence_id": recording}
    kinds = [
        client.post(f"{API}/jobs", json=told | kind).json()["kind"]
        for kind in ({}, {"kind": "track"}, {"kind": "detect"})
    ]
    assert kinds == ["track", "track", "detect"]
    acts = client.get(f"{API}/audit", params={"act": "job.start"}).json()["items"]
    assert {line["subject_id"] for line in acts} == {job["id"] for job in client.get(f"{API}/jobs").json()["items"]}


@pytest.mark.parametrize(
    ("body", "named"),
    [
        ({"kind": "juggle", "sequence_id": NOBODY}, "kind"),
        ({"kind": "detect"}, "sequence_id"),
        ({"kind": "detect", "sequence_id": NOBODY, "name": "x"}, "name"),
        ({"kind": 7}, "kind"),
        ([], ""),
    ],
    ids=["unknown", "nothing to do it on", "of another kind", "no word", "no object"],
)
def test_a_body_that_makes_no_sense_is_refused_with_what_is_wrong(client: TestClient, body: Any, named: str) -> None:
    answer = client.post(f"{API}/jobs", json=body)
    assert answer.status_code == 422 and named in answer.json()["detail"]


def test_the_old_request_names_the_new_one(client: TestClient, add_recording: AddRecording) -> None:
    answer = client.post(f"{API}/jobs/detect", json={"sequence_id": add_recording()["id"]})
    assert answer.status_code == 201 and "Deprecation" in answer.headers
    assert answer.headers["Link"] == '</api/v1/jobs>; rel="successor-version"'
