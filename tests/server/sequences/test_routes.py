"""`/sequences`: listed, searched, changed by two at once, deleted and brought back."""

from __future__ import annotations

import json
import uuid

from fastapi.testclient import TestClient


def test_a_recording_is_described_in_full(client: TestClient, add_recording) -> None:
    found = add_recording("waving", frames=4)
    assert found["name"] == "waving"
    assert (found["fps"], found["frame_count"], found["hands"], found["objects"]) == (30.0, 4, ["right"], [])
    assert (found["revision"], found["annotated_frames"], found["best_track"]) == (1, 0, None)
    assert len(found["content_key"]) == 32
    assert found["created_at"].endswith(("Z", "+00:00"))
    (camera,) = found["cameras"]
    assert (camera["id"], camera["width"], camera["height"], camera["depth_scale"]) == ("cam0", 32, 24, 0.001)
    assert camera["has_color"] and camera["has_depth"]
    assert 0.35 < camera["depth_near"] < 0.45 and 0.75 < camera["depth_far"] < 0.85
    assert found["report"]["ok"]


def test_lists_are_newest_first_and_paged_without_gaps(client: TestClient, add_recording) -> None:
    names = [add_recording(f"take {n}", frames=1)["name"] for n in range(5)]
    seen, cursor = [], None
    for _ in range(3):
        page = client.get("/api/v1/sequences", params={"limit": 2} | ({"cursor": cursor} if cursor else {})).json()
        seen += [item["name"] for item in page["items"]]
        cursor = page["next_cursor"]
    assert seen == names[::-1]
    assert cursor is None


def test_search_wants_every_word_and_takes_wildcards_for_what_they_are(client: TestClient, add_recording) -> None:
    for name in ("Ball left 50%", "ball RIGHT", "cube right"):
        add_recording(name, frames=1)

    def search(text: str) -> set[str]:
        return {item["name"] for item in client.get("/api/v1/sequences", params={"search": text}).json()["items"]}

    assert search("right ball") == {"ball RIGHT"}
    assert search("BALL") == {"Ball left 50%", "ball RIGHT"}
    assert search("%") == {"Ball left 50%"}
    assert search("_") == set()


def test_a_cursor_of_somebody_else_is_refused_in_words(client: TestClient) -> None:
    for cursor in ("x", "WzFd", "W10", "-----", "a" * 900, "WyIyMDI2IiwgIngiXQ"):
        answer = client.get("/api/v1/sequences", params={"cursor": cursor})
        assert (answer.status_code, answer.json()["error"]) == (404, "UnknownCursorError"), cursor


def test_the_second_of_two_changes_sees_the_first(client: TestClient, add_recording, studio) -> None:
    found = add_recording()
    url = f"/api/v1/sequences/{found['id']}"
    assert client.patch(url, json={"name": "a"}).status_code == 428
    assert client.get(url).headers["etag"] == '"1"'
    changed = client.patch(url, json={"name": " renamed ", "hands": ["left", "right"]}, headers={"If-Match": '"1"'})
    assert changed.status_code == 200
    assert changed.headers["etag"] == '"2"'
    assert (changed.json()["name"], changed.json()["hands"]) == ("renamed", ["left", "right"])
    assert changed.json()["content_key"] == found["content_key"]
    late = client.patch(url, json={"name": "mine"}, headers={"If-Match": '"1"'})
    assert late.status_code == 409
    assert late.json()["error"] == "ConflictError"
    assert late.json()["theirs"] == changed.json()
    folder = studio.app.state.storage.folder("sequences", uuid.UUID(found["id"]))
    document = json.loads((folder / "sequence.json").read_text())
    assert (document["name"], document["hands"]) == ("renamed", ["left", "right"])


def test_changes_that_make_no_sense_are_refused_and_change_nothing(client: TestClient, add_recording) -> None:
    found = add_recording()
    url = f"/api/v1/sequences/{found['id']}"
    for body in ({"name": "  "}, {"name": "a\nb"}, {"name": "x" * 201}, {"hands": ["right", "right"]}, {"fps": 3}):
        answer = client.patch(url, json=body, headers={"If-Match": '"1"'})
        assert (answer.status_code, set(answer.json())) == (422, {"error", "detail"}), body
    for tag in ("1", '"one"', "*", '"1", "2"'):
        assert client.patch(url, json={"name": "a"}, headers={"If-Match": tag}).status_code == 422, tag
    assert client.get(url).json() == found


def test_a_deleted_recording_is_gone_until_it_is_restored(client: TestClient, add_recording) -> None:
    found = add_recording()
    url = f"/api/v1/sequences/{found['id']}"
    assert client.delete(url).status_code == 204
    assert client.get(url).status_code == 404
    assert client.delete(url).status_code == 404
    assert client.get("/api/v1/sequences").json()["items"] == []
    assert client.post(f"{url}/restore").json()["name"] == found["name"]
    assert client.get(url).json() == found
    assert client.get(f"/api/v1/sequences/{uuid.uuid4()}").status_code == 404
