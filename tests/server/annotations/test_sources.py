"""Where joints came from: what was accepted from a machine is told from what a hand placed, for good."""

from __future__ import annotations

import json
import uuid
from typing import Any

import pytest
from fastapi.testclient import TestClient

from server.annotations.models import AnnotationRow
from server.annotations.schemas import AnnotationOut, JointSourceOut
from server.annotations.sources import count_decided
from server.database import Database
from tracker import load_annotations
from tracker.capture import JointSource

FIRST = {"If-None-Match": "*"}
TRACK = {"kind": "track", "label": "Track 2", "track_id": str(uuid.UUID(int=7)), "model": "hand"}
FIT = {"kind": "fit", "label": "model fit of 7 joints"}


@pytest.fixture
def recording(add_recording) -> str:
    return f"/api/v1/sequences/{add_recording('waving')['id']}"


def hand(x: float = 1.5) -> list[list[float]]:
    return [[x, 2.25, 2]] * 19 + [[-1.0, -1.0, 0], [0.0, 0.0, 0]]


def put(client: TestClient, place: str, points: Any, sources: Any = None, revision: int | None = None) -> Any:
    body = {"points": points, "operation_id": str(uuid.uuid4())} | ({} if sources is None else {"sources": sources})
    headers = FIRST if revision is None else {"If-Match": f'"{revision}"'}
    answer = client.put(place, json=body, headers=headers)
    assert answer.status_code == 200, answer.text
    return answer.json()


def kinds(found: Any) -> list[str | None]:
    return [source and source["kind"] for source in found["sources"]]


def test_the_list_says_of_each_hand_what_its_own_address_says(client, recording) -> None:
    base = f"{recording}/annotations"
    for frame in (0, 1):
        sources = [TRACK] * 4 + [FIT] + [None] * 16 if frame else None
        put(client, f"{base}/cam0/{frame}/right", hand(), sources)
    each = [client.get(f"{base}/cam0/{frame}/right").json() for frame in (0, 1)]
    assert client.get(base).json() == {"items": each, "next_cursor": None}
    assert (
        AnnotationOut.model_validate(each[1]).sources
        == [JointSourceOut.model_validate(TRACK)] * 4 + [JointSourceOut.model_validate(FIT)] + [None] * 16
    )


def test_what_was_accepted_stays_beside_the_label_in_its_history_and_in_the_file(client, recording, tmp_path) -> None:
    place = f"{recording}/annotations/cam0/1/right"
    made = put(client, place, hand(), [TRACK] * 4 + [FIT] + [None] * 16)
    assert kinds(made) == ["track"] * 4 + ["fit"] + [None] * 16
    moved = hand()
    moved[2] = [20.0, 12.0, 2]
    moved[3] = [1.5, 2.25, 1]
    later = put(client, place, moved, revision=1)
    assert kinds(later) == ["track", "track", None, "track", "fit"] + [None] * 16, "a joint that was moved is by hand"
    history = client.get(f"{place}/history").json()["items"]
    assert [kinds(item)[2] for item in history] == [None, "track"]

    path = tmp_path / "annotations.json"
    path.write_bytes(client.get(f"{recording}/annotations.json").content)
    (found,) = load_annotations(path).items
    assert found.sources is not None
    assert found.sources[0] == JointSource("track", "Track 2", uuid.UUID(int=7), "hand")
    assert found.sources[2] is None

    back = {"operation_id": str(uuid.uuid4())}
    restored = client.post(f"{place}/history/1/restore", json=back, headers={"If-Match": '"2"'})
    assert kinds(restored.json())[2] == "track"


def test_a_snapshot_and_its_restore_keep_them(client: TestClient, recording: str) -> None:
    place = f"{recording}/annotations/cam0/1/right"
    put(client, place, hand(), [TRACK] * 21)
    kept = client.post(f"{recording}/labels/snapshots", json={"name": "Before"}).json()
    put(client, place, hand(9), revision=1)
    assert client.post(f"/api/v1/snapshots/{kept['id']}/restore").status_code == 200
    assert kinds(client.get(place).json()) == ["track"] * 21


def test_what_comes_in_a_file_says_so(client: TestClient, recording: str) -> None:
    place = f"{recording}/annotations/cam0/1/right"
    put(client, place, hand())
    file = client.get(f"{recording}/annotations.json").json()
    file["items"][0]["points"][0][0] = 7.5
    for sources, found in ((None, ["import"] * 20 + [None]), ([FIT] * 21, ["fit"] * 21)):
        file["items"][0] |= {"sources": sources}
        file["items"][0]["points"][1][0] += 1
        sent = {"files": ("annotations.json", json.dumps(file))}
        check = client.post(f"{recording}/labels/check", files=sent).json()["check"]
        done = client.post(f"{recording}/labels/import", files=sent, data={"policy": "replace", "check": check})
        assert done.status_code == 200, done.text
        assert kinds(client.get(place).json()) == found


@pytest.mark.parametrize(
    "wrong", [[TRACK] * 20, [{"kind": "magic"}] * 21, [TRACK | {"label": "a\x00b"}] * 21, [FIT | {"sure": True}] * 21]
)
def test_wrong_sources_are_refused(client: TestClient, recording: str, wrong: list[Any]) -> None:
    body = {"points": hand(), "sources": wrong, "operation_id": str(uuid.uuid4())}
    answer = client.put(f"{recording}/annotations/cam0/1/right", json=body, headers=FIRST)
    assert answer.status_code == 422


def test_frames_are_done_when_every_joint_is_decided(client: TestClient, recording: str, database: Database) -> None:
    put(client, f"{recording}/annotations/cam0/1/right", hand())
    whole = [*hand()[:20], [4.0, 4.0, 1]]
    put(client, f"{recording}/annotations/cam0/2/right", whole)
    assert (count_decided(hand()), count_decided(whole), count_decided(None)) == (20, 21, 0)
    found = client.get(recording).json()
    hands = found["hands"]
    assert (found["annotated_frames"], found["done_frames"]) == (2, 1 if hands == ["right"] else 0)
    with database.reading() as session:
        assert sorted(row.decided for row in session.query(AnnotationRow)) == [20, 21]


def test_key_frames_are_everybodys(client: TestClient, recording: str) -> None:
    place = f"{recording}/key-frames/cam0"
    for path in (f"{place}/2/right", f"{place}/1/right", f"{place}/2/right"):
        assert client.put(path).status_code == 204
    wanted = [{"frame": 1, "camera": "cam0", "hand": "right"}, {"frame": 2, "camera": "cam0", "hand": "right"}]
    assert client.get(f"{recording}/key-frames").json()["items"] == wanted
    for _ in range(2):
        assert client.delete(f"{place}/1/right").status_code == 204
    assert client.get(f"{recording}/key-frames").json()["items"] == wanted[1:]
    assert client.put(f"{place}/999/right").status_code == 404
    assert client.put(f"{recording}/key-frames/cam9/1/right").status_code == 404
