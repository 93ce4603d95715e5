"""Cameras refined from labels, by the API."""

from __future__ import annotations

import uuid
from pathlib import Path

import numpy as np
import pytest

from server.access.models import LOCAL_ACCOUNT_ID
from server.imports.service import ImportContext, import_recording
from tests.tracker.calibration.labelled_hands import find_farthest_off_px, record_knocked, stand_around
from tracker import load_sequence


@pytest.fixture
def recording_id(studio, tmp_path: Path, rng: np.random.Generator) -> uuid.UUID:
    """Four cameras of which three were knocked, with labels of 40 frames."""
    record_knocked(tmp_path / "knocked", rng)
    desk = ImportContext(studio.database, studio.app.state.storage, studio.settings)
    return import_recording(desk, tmp_path / "knocked", {}, LOCAL_ACCOUNT_ID)


def propose(client, recording_id: uuid.UUID, **options) -> dict:
    answer = client.post(f"/api/v1/sequences/{recording_id}/refinements", json=options)
    assert answer.status_code == 201, answer.text
    return answer.json()


def read(client, recording_id: uuid.UUID) -> dict:
    return client.get(f"/api/v1/sequences/{recording_id}").json()


def open_files(studio, recording_id: uuid.UUID):
    return load_sequence(studio.app.state.storage.folder("sequences", recording_id))


def test_a_proposal_shows_before_and_after_and_changes_nothing(client, studio, recording_id) -> None:
    before = read(client, recording_id)
    files = open_files(studio, recording_id).to_json()
    found = propose(client, recording_id)
    assert found["state"] == "proposed" and found["is_current"]
    assert found["report"]["refusal"] == "" and found["report"]["frames_left_out"] == 8
    for camera in found["report"]["cameras"]:
        assert camera["left_out_px"]["after"]["rms"] < camera["left_out_px"]["before"]["rms"]
    assert [camera["moved_mm"] > 1 for camera in found["report"]["cameras"]] == [False, True, True, True]
    assert read(client, recording_id) == before and open_files(studio, recording_id).to_json() == files
    assert client.get(f"/api/v1/sequences/{recording_id}/refinements").json() == [found]


def test_taken_cameras_are_the_recordings_everywhere_and_are_put_back_to_the_last_digit(
    client, studio, recording_id
) -> None:
    before, files = read(client, recording_id), open_files(studio, recording_id).to_json()
    found = propose(client, recording_id)
    taken = client.post(f"/api/v1/refinements/{found['id']}/take")
    assert taken.status_code == 200 and taken.json()["state"] == "taken"
    after = read(client, recording_id)
    assert after["revision"] == before["revision"] + 1 and after["content_key"] != before["content_key"]
    now = open_files(studio, recording_id)
    assert find_farthest_off_px(now.cameras, stand_around(4)) < 3
    for row, camera in zip(after["cameras"], now.cameras, strict=True):
        assert row["T_world_camera"] == camera.T_world_camera.tolist()

    back = client.post(f"/api/v1/refinements/{found['id']}/put-back")
    assert back.status_code == 200 and back.json()["state"] == "put_back"
    again = read(client, recording_id)
    assert again["cameras"] == before["cameras"] and again["content_key"] == before["content_key"]
    assert open_files(studio, recording_id).to_json() == files
    # The two changes are known with who made them.
    acts = [line["act"] for line in client.get("/api/v1/audit", params={"act": "cameras"}).json()["items"]]
    assert acts == ["cameras.put_back", "cameras.taken"]


def test_labels_stay_with_their_pictures_when_cameras_are_taken(client, recording_id) -> None:
    labels = client.get(f"/api/v1/sequences/{recording_id}/annotations.json").json()
    client.post(f"/api/v1/refinements/{propose(client, recording_id)['id']}/take")
    assert client.get(f"/api/v1/sequences/{recording_id}/annotations.json").json() == labels


def test_a_proposal_of_earlier_cameras_is_not_taken(client, recording_id) -> None:
    first, second = propose(client, recording_id), propose(client, recording_id)
    assert client.post(f"/api/v1/refinements/{first['id']}/take").status_code == 200
    late = client.post(f"/api/v1/refinements/{second['id']}/take")
    assert late.status_code == 409 and "changed meanwhile" in late.json()["detail"]
    twice = client.post(f"/api/v1/refinements/{first['id']}/take")
    assert twice.status_code == 409 and "were taken already" in twice.json()["detail"]
    known = {one["id"]: one["is_current"] for one in client.get(f"/api/v1/sequences/{recording_id}/refinements").json()}
    assert known == {first["id"]: True, second["id"]: False}


def test_cameras_that_get_no_better_cannot_be_taken(client, recording_id) -> None:
    client.post(f"/api/v1/refinements/{propose(client, recording_id)['id']}/take")
    again = propose(client, recording_id)
    assert "already agree as well as labels" in again["report"]["refusal"]
    refused = client.post(f"/api/v1/refinements/{again['id']}/take")
    assert refused.status_code == 422 and refused.json()["detail"].startswith("The cameras stay as they are.")


def test_cameras_are_not_changed_under_a_job(client, studio, recording_id) -> None:
    found = propose(client, recording_id)
    started = client.post("/api/v1/jobs", json={"kind": "track", "sequence_id": str(recording_id), "params": {}})
    assert started.status_code == 201, started.text
    busy = client.post(f"/api/v1/refinements/{found['id']}/take")
    assert busy.status_code == 409 and "Wait for its end" in busy.json()["detail"]


def test_a_recording_with_too_few_labels_is_told_what_is_needed(client, add_recording) -> None:
    answer = client.post(f"/api/v1/sequences/{add_recording()['id']}/refinements", json={})
    assert answer.status_code == 422 and "No two cameras share more than 0 labelled joints" in answer.json()["detail"]
    assert client.post(f"/api/v1/sequences/{uuid.uuid4()}/refinements", json={}).status_code == 404
    assert client.post(f"/api/v1/refinements/{uuid.uuid4()}/take").status_code == 404
