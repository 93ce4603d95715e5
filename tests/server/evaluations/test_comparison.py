"""Tracks side by side over REST, against what plain NumPy makes of the same files."""

from __future__ import annotations

import csv
import hashlib
import io
import json
import uuid
from typing import Any

import cv2
import numpy as np
import pytest
from fastapi.testclient import TestClient

from server.access.project_models import ProjectRow, ProjectSequenceRow
from server.annotations.snapshot_models import SnapshotRow
from server.database import Database
from tests.server.conftest import Studio, Tracked
from tests.server.evaluations.conftest import AddShifted

API = "/api/v1"


def get(client: TestClient, **params: Any) -> dict[str, Any]:
    answer = client.get(f"{API}/evaluations", params=params)
    assert answer.status_code == 200, answer.text
    return answer.json()


def plain_errors(studio: Studio, tracked: Tracked, track_id: str) -> np.ndarray:
    """(12, 21) px, from the files alone."""
    storage = studio.app.state.storage
    with np.load(storage.folder("tracks", uuid.UUID(track_id)) / "track.npz") as arrays:
        joints = arrays["joints_2d"][:, 0, :21]
    marks = studio.client.get(f"{API}/sequences/{tracked.sequence_id}/annotations.json").json()["items"]
    points = np.array([item["points"] for item in marks if item["frame"] < 12])
    return np.where(points[:, :, 2] > 0, np.hypot(*np.moveaxis(joints - points[:, :, :2], 2, 0)), np.nan)


def test_two_tracks_are_compared_joint_by_joint(studio, client, tracked, add_shifted: AddShifted) -> None:
    near, far = str(tracked.track_id), add_shifted(1.0, terms="LO", iterations=5)
    found = get(client, track=[near, far], reference=near, within=4)
    first, second = found["tracks"]
    assert [first["key"], second["key"], found["reference"]] == [near, far, near]
    errors = [plain_errors(studio, tracked, key) for key in (near, far)]
    for track, error in zip(found["tracks"], errors, strict=True):
        known = error[np.isfinite(error)]
        assert track["error"]["mean"] == pytest.approx(known.mean())
        assert track["error"]["std"] == pytest.approx(known.std())
        assert track["error"]["p95"] == pytest.approx(np.percentile(known, 95))
        assert track["within"] == pytest.approx((known <= 4).mean())
        assert track["curve"]["mean"] == pytest.approx(np.nanmean(error, axis=1))
        assert (track["frames"], track["annotated_frames"], track["annotated"]) == (12, 12, 45)
        assert track["untracked"] == 45 - 12
    assert second["paired"]["difference"] == pytest.approx(np.nanmean(errors[1] - errors[0]))
    assert second["paired"]["low"] > 0
    differing = {item["name"]: item["values"] for item in found["parameters"]["different"]}
    assert differing["terms"] == {near: "LO+SC", far: "LO"}
    assert differing["iterations"] == {near: 10, far: 5}
    assert found["parameters"]["same"]["recover"] is True


def test_the_verdict_names_its_labels_and_follows_them(client, tracked) -> None:
    track = get(client, sequence=str(tracked.sequence_id))["tracks"][0]
    labels = track["labels"]
    assert (labels["kind"], labels["revision"], labels["items"]) == ("now", 45, 45)
    address = f"{API}/sequences/{tracked.sequence_id}"
    written = client.get(f"{address}/annotations.json").json()
    assert labels["sha256"] == hashlib.sha256((json.dumps(written, separators=(",", ":")) + "\n").encode()).hexdigest()
    place = f"{address}/annotations/cam0/3/right"
    theirs = client.get(place)
    points = [[x + 40, y, v] for x, y, v in theirs.json()["points"]]
    body = {"points": points, "operation_id": str(uuid.uuid4())}
    assert client.put(place, json=body, headers={"If-Match": theirs.headers["etag"]}).status_code == 200
    after = get(client, track=str(tracked.track_id))["tracks"][0]
    assert after["labels"]["revision"] == 46
    assert after["labels"]["sha256"] != labels["sha256"]
    assert after["worst"][0]["frame"] == 3
    assert after["worst"][0]["mean_px"] == pytest.approx(40, abs=3)


def test_a_snapshot_judges_as_it_did_whatever_happens_to_the_labels(studio, client, tracked) -> None:
    snapshot_id = uuid.uuid4()
    address = f"{API}/sequences/{tracked.sequence_id}"
    content = client.get(f"{address}/annotations.json").content
    path = studio.app.state.storage.folder("snapshots", snapshot_id).with_suffix(".json")
    path.write_bytes(content)
    row = SnapshotRow(
        id=snapshot_id, sequence_id=tracked.sequence_id, version=1, name="As imported",
        content_hash=hashlib.sha256(content).hexdigest(), item_count=45, joint_count=945,
    )  # fmt: skip
    with studio.database.writing() as session:
        session.add(row)
    before = get(client, track=str(tracked.track_id))["tracks"][0]["error"]
    for frame in range(6):
        place = f"{address}/annotations/cam0/{frame}/right"
        assert client.delete(place, headers={"If-Match": '"1"'}).is_success
    now = get(client, track=str(tracked.track_id))["tracks"][0]
    then = get(client, track=str(tracked.track_id), snapshot=str(snapshot_id))["tracks"][0]
    assert now["annotated_frames"] == 6
    assert then["error"] == before
    assert then["labels"]["sha256"] == hashlib.sha256(content).hexdigest()
    assert (then["labels"]["kind"], then["labels"]["name"]) == ("snapshot", "As imported")
    assert client.get(then["worst"][0]["picture"]).status_code == 200
    missing = client.get(f"{API}/evaluations", params={"track": str(tracked.track_id), "snapshot": str(uuid.uuid4())})
    assert missing.status_code == 404


def test_a_part_counts_alone(studio, client, tracked, add_shifted: AddShifted) -> None:
    errors = plain_errors(studio, tracked, str(tracked.track_id))
    whole = get(client, track=str(tracked.track_id))["tracks"][0]
    visible = get(client, track=str(tracked.track_id), visibility="visible")["tracks"][0]
    assert visible["error"] == whole["visible"]
    later = get(client, track=str(tracked.track_id), without_start=True)["tracks"][0]
    assert later["error"]["mean"] == pytest.approx(np.nanmean(errors[1:]))
    assert get(client, track=str(tracked.track_id), hand="left")["tracks"][0]["error"]["count"] == 0


def test_a_project_is_judged_as_a_whole_by_method(studio, client, tracked, rendered, add_shifted: AddShifted) -> None:
    from server.access.models import LOCAL_ACCOUNT_ID
    from server.imports.service import ImportContext, import_recording

    desk = ImportContext(studio.database, studio.app.state.storage, studio.settings)
    second = import_recording(desk, rendered, {}, LOCAL_ACCOUNT_ID)
    tracks = [str(tracked.track_id), add_shifted(2.0, terms="LO"), add_shifted(0.0, second)]
    tracks.append(add_shifted(1.0, second, terms="LO"))
    project = ProjectRow(id=uuid.uuid4(), name="Hands that open")
    with studio.database.writing() as session:
        session.add(project)
        session.flush()
        for place in (tracked.sequence_id, second):
            session.add(ProjectSequenceRow(project_id=project.id, sequence_id=place))
    sequences = [str(tracked.sequence_id), str(second)]
    found = get(client, sequence=sequences, reference=tracks[0])
    assert {track["key"] for track in found["tracks"]} == set(tracks)
    methods = {method["name"]: method for method in found["methods"]}
    assert set(methods) == {"terms LO", "terms LO+SC"}
    assert methods["terms LO"]["recordings"] == 2
    assert methods["terms LO"]["paired"]["frames"] == 24
    assert 5 < methods["terms LO"]["paired"]["difference"] < 10
    of_project = get(client, project=str(project.id))
    assert {track["recording_key"] for track in of_project["tracks"]} == set(sequences)
    assert client.get(f"{API}/evaluations", params={"project": str(uuid.uuid4())}).status_code == 404


def test_a_picture_of_a_worst_frame_can_be_kept_until_the_labels_change(client, tracked) -> None:
    worst = get(client, track=str(tracked.track_id))["tracks"][0]["worst"][0]
    answer = client.get(worst["picture"])
    assert answer.status_code == 200 and "immutable" in answer.headers["cache-control"]
    image = cv2.imdecode(np.frombuffer(answer.content, np.uint8), cv2.IMREAD_COLOR)
    assert image is not None and image.shape == (288, 384, 3) and image.std() > 10
    assert client.get(worst["picture"], headers={"If-None-Match": answer.headers["etag"]}).status_code == 304
    place = f"{API}/sequences/{tracked.sequence_id}/annotations/cam0/{worst['frame']}/right"
    client.delete(place, headers={"If-Match": '"1"'})
    assert client.get(worst["picture"]).status_code == 404
    other = get(client, track=str(tracked.track_id))["tracks"][0]["worst"][0]
    assert (other["frame"], other["picture"]) != (worst["frame"], worst["picture"])


def test_reports_hold_what_the_comparison_says(client, tracked, add_shifted: AddShifted) -> None:
    params = {"track": [str(tracked.track_id), add_shifted(1.0)], "within": 5}
    found = get(client, **params)
    page = client.get(f"{API}/evaluations/report.html", params=params)
    assert page.headers["content-disposition"].startswith("attachment")
    assert "sandbox" in page.headers["content-security-policy"]
    for track in found["tracks"]:
        assert f"{track['error']['mean']:.2f}" in page.text
        assert track["labels"]["sha256"] in page.text and track["origin"]["sha256"] in page.text
    assert page.text.count("data:image/jpeg;base64,") == 24
    rows = list(csv.DictReader(io.StringIO(client.get(f"{API}/evaluations/report.csv", params=params).text)))
    for track in found["tracks"]:
        errors = [float(row["error_px"]) for row in rows if row["track_id"] == track["key"]]
        assert np.mean(errors) == pytest.approx(track["error"]["mean"], abs=1e-3)
    written = client.get(f"{API}/evaluations/report.json", params=params).json()
    assert written | {"made_at": 0} == found | {"made_at": 0}


def test_what_makes_no_sense_is_refused_with_the_next_step(client, tracked) -> None:
    def detail(status: int, **params: Any) -> str:
        answer = client.get(f"{API}/evaluations", params=params)
        assert answer.status_code == status, answer.text
        return answer.json()["detail"]

    track = str(tracked.track_id)
    assert "There is no track" in detail(404, track=str(uuid.uuid4()))
    assert "none of the 1 tracks" in detail(404, track=track, reference=str(uuid.uuid4()))
    detail(422, track=[str(uuid.uuid4()) for _ in range(61)])
    detail(422, track=track, within="nan")
    detail(422, track=track, trakc="x")
    assert get(client)["tracks"] == []
    assert client.get(f"{API}/evaluations/report.html").status_code == 422
    address = f"{API}/tracks/{track}/evaluation"
    assert client.get(f"{address}/now-45/cam0/44/right.jpg").status_code == 404
    assert client.get(f"{address}/now-45/cam7/0/right.jpg").status_code == 404
    assert client.get(f"{address}/snapshot-{tracked.track_id}/cam0/0/right.jpg").status_code == 404
    assert client.get(f"{address}/yesterday/cam0/0/right.jpg").status_code == 422


def test_a_verdict_is_worked_out_once(studio, client, tracked, monkeypatch) -> None:
    from server.evaluations.judge import Judge

    judged = []
    work = Judge._judge

    def count(self: Judge, database: Database, track_id: uuid.UUID, labels: Any) -> Any:
        judged.append(labels.key)
        return work(self, database, track_id, labels)

    monkeypatch.setattr(Judge, "_judge", count)
    for _ in range(3):
        get(client, track=str(tracked.track_id))
        client.get(f"{API}/tracks/{tracked.track_id}/evaluation")
    assert judged == ["now-45"]
    client.delete(f"{API}/sequences/{tracked.sequence_id}/annotations/cam0/0/right", headers={"If-Match": '"1"'})
    get(client, track=str(tracked.track_id))
    assert judged == ["now-45", "now-46"]
