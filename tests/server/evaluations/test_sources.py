"""A track is judged by joints that no track had a part in, unless others are asked for; how many is always said."""

from __future__ import annotations

import csv
import io
import uuid
from typing import Any, get_args

import numpy as np
import pytest
from fastapi.testclient import TestClient

from server.annotations.schemas import SourceChoice
from tests.server.conftest import Studio, Tracked
from tests.server.evaluations.conftest import AddShifted
from tracker.capture.source_choice import SOURCE_CHOICES

API = "/api/v1"
OFF = 7.0
"""How far marks by hand lie from the track, px."""


def change(client: TestClient, tracked: Tracked, frame: int, points: Any, sources: Any) -> None:
    place = f"{API}/sequences/{tracked.sequence_id}/annotations/cam0/{frame}/right"
    headers = {"If-Match": client.get(place).headers["etag"]}
    body = {"points": points, "sources": sources, "operation_id": str(uuid.uuid4())}
    answer = client.put(place, json=body, headers=headers)
    assert answer.status_code == 200, answer.text


@pytest.fixture
def accepted(studio: Studio, client: TestClient, tracked: Tracked) -> Tracked:
    """Frame 1: accepted from the track. Frame 2: by hand, `OFF` px beside it, but the thumb's tip is a copy of one of
    the track's. Frame 3: accepted from another track. Frame 4: a model fit. Frame 5: interpolated between hand-placed
    joints. Frame 6: interpolated, nobody noted between what. All others are gone."""
    folder = studio.app.state.storage.folder("tracks", tracked.track_id)
    with np.load(folder / "track.npz") as arrays:
        joints = arrays["joints_2d"][:, 0, :21].astype(float)
    points = [[[float(x), float(y), 2] for x, y in frame] for frame in joints]
    by_hand = [[x + OFF, y, v] for x, y, v in points[2]]
    by_hand[4] = points[2][4]
    own = {"kind": "track", "label": "Track 1", "track_id": str(tracked.track_id)}
    other = own | {"label": "Track 9", "track_id": str(uuid.uuid4())}
    fit = {"kind": "fit", "label": "model fit of 7 joints"}
    between = {"kind": "interpolation", "label": "key frames 2 and 9"}
    change(client, tracked, 1, points[1], [own] * 21)
    change(client, tracked, 2, by_hand, [None] * 4 + [{"kind": "copy", "label": "frame 1"}] + [None] * 16)
    change(client, tracked, 3, points[3], [other] * 21)
    change(client, tracked, 4, points[4], [fit] * 21)
    five = [[x, y + OFF, v] for x, y, v in points[5]]
    change(client, tracked, 5, five, [between | {"is_independent": True}] * 21)
    change(client, tracked, 6, points[6], [between] * 21)
    for item in client.get(f"{API}/sequences/{tracked.sequence_id}/annotations.json").json()["items"]:
        if item["frame"] not in range(1, 7):
            place = f"{API}/sequences/{tracked.sequence_id}/annotations/cam0/{item['frame']}/right"
            client.delete(place, headers={"If-Match": client.get(place).headers["etag"]})
    return tracked


def test_the_choices_of_the_api_are_those_of_the_tracker() -> None:
    assert set(get_args(SourceChoice)) == set(SOURCE_CHOICES)


def test_a_track_does_not_judge_itself(client: TestClient, accepted: Tracked) -> None:
    found = client.get(f"{API}/tracks/{accepted.track_id}/evaluation").json()
    assert found["joint_error_px"]["count"] == 20 + 21
    assert found["joint_error_px"]["mean"] == pytest.approx(OFF, abs=0.01)
    assert (found["evaluated"], found["left_out_joints"]) == (2, 4 * 21 + 1)
    told = {one["words"]: (one["joints"], one["is_counted"]) for one in found["sources"]}
    assert told == {
        "placed by hand": (20, True),
        "interpolated between key frames": (21, True),
        "accepted from Track 1": (21, False),
        "accepted from Track 9": (21, False),
        "accepted from a model fit": (21, False),
        "interpolated between key frames and not known to be free of a track": (21, False),
        "copied from another frame and not known to be free of a track": (1, False),
    }
    kept = client.get(f"{API}/tracks/{accepted.track_id}").json()["error_px"]
    assert kept == pytest.approx(OFF, abs=0.01)
    card = client.get(f"{API}/sequences/{accepted.sequence_id}").json()["best_track"]["error_px"]
    assert card == pytest.approx(OFF, abs=0.01)


def test_without_any_independent_joint_there_is_no_error(client: TestClient, accepted: Tracked) -> None:
    for frame in (2, 5):
        place = f"{API}/sequences/{accepted.sequence_id}/annotations/cam0/{frame}/right"
        client.delete(place, headers={"If-Match": client.get(place).headers["etag"]})
    found = client.get(f"{API}/tracks/{accepted.track_id}/evaluation").json()
    assert (found["joint_error_px"]["count"], found["evaluated"], found["worst"]) == (0, 0, [])
    assert client.get(f"{API}/tracks/{accepted.track_id}").json()["error_px"] is None


def test_others_count_when_they_are_asked_for(client: TestClient, accepted: Tracked) -> None:
    address = f"{API}/evaluations"

    def judge(*source: str) -> dict[str, Any]:
        answer = client.get(address, params={"track": str(accepted.track_id), "source": source})
        assert answer.status_code == 200, answer.text
        assert answer.json()["source"] == list(source)
        return answer.json()["tracks"][0]

    assert judge("all")["error"]["count"] == 6 * 21
    assert judge("all")["left_out_joints"] == 0
    assert judge("hand")["error"]["count"] == 20
    assert judge("hand", "fit")["error"]["count"] == 20 + 21
    assert judge("independent", "track")["error"]["count"] == 41 + 42
    assert judge("track")["error"]["mean"] == pytest.approx(0.0, abs=0.01)
    assert [row["frame"] for row in judge("independent")["worst"]] in ([2, 5], [5, 2])
    assert judge("independent")["curve"]["frame"] == [2, 5]
    found = client.get(f"{API}/tracks/{accepted.track_id}/evaluation", params={"source": "all"}).json()
    assert found["joint_error_px"]["count"] == 6 * 21
    assert client.get(f"{API}/tracks/{accepted.track_id}").json()["error_px"] == pytest.approx(OFF, abs=0.01)
    assert client.get(address, params={"track": str(accepted.track_id), "source": "guess"}).status_code == 422


def test_differences_are_over_joints_that_no_track_made(
    client: TestClient, accepted: Tracked, add_shifted: AddShifted
) -> None:
    other = add_shifted(1.0)
    tracks = [str(accepted.track_id), other]
    found = client.get(f"{API}/evaluations", params={"track": tracks}).json()["tracks"][1]
    assert found["paired"]["joints"] == 41


def test_reports_say_how_many_joints_were_left_out_and_why(client: TestClient, accepted: Tracked) -> None:
    query = {"track": str(accepted.track_id)}
    rows = list(csv.DictReader(io.StringIO(client.get(f"{API}/evaluations/report.csv", params=query).text)))
    assert len(rows) == 6 * 21
    judged = [row for row in rows if row["counts"] == "yes"]
    assert len(judged) == 41 and {row["source"] for row in judged} == {
        "placed by hand",
        "interpolated between key frames",
    }
    assert [float(row["error_px"]) for row in judged] == pytest.approx([OFF] * 41, abs=0.01)
    assert {row["error_px"] for row in rows if row["counts"] == "left out"} == {""}
    page = client.get(f"{API}/evaluations/report.html", params=query).text
    assert "85 joints are left out because of their source: " in page
    assert "21 accepted from Track 1" in page and "judged by 21 interpolated between key frames, 20 placed" in page
    document = client.get(f"{API}/evaluations/report.json", params=query).json()
    assert document["source"] == ["independent"] and document["tracks"][0]["left_out_joints"] == 85
    everything = client.get(f"{API}/evaluations/report.html", params=query | {"source": "all"}).text
    assert "Joints that count: all." in everything and "are left out because" not in everything


def test_the_picture_of_a_worst_frame_shows_what_counted(client: TestClient, accepted: Tracked) -> None:
    query = {"track": str(accepted.track_id)}
    usual = client.get(f"{API}/evaluations", params=query).json()["tracks"][0]["worst"]
    whole = client.get(f"{API}/evaluations", params=query | {"source": "all"}).json()["tracks"][0]["worst"]
    at = {row["frame"]: row["picture"] for row in usual}[2], {row["frame"]: row["picture"] for row in whole}[2]
    assert at[1].endswith("?source=all")
    answers = [client.get(address) for address in at]
    assert [answer.status_code for answer in answers] == [200, 200]
    assert answers[0].content != answers[1].content and answers[0].headers["etag"] != answers[1].headers["etag"]


def test_a_snapshot_carries_its_sources(client: TestClient, accepted: Tracked) -> None:
    made = client.post(f"{API}/sequences/{accepted.sequence_id}/labels/snapshots", json={"name": "Mixed"}).json()
    query = {"track": str(accepted.track_id), "snapshot": made["id"]}
    found = client.get(f"{API}/evaluations", params=query).json()["tracks"][0]
    assert (found["error"]["count"], found["left_out_joints"]) == (41, 85)
