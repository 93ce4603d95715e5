"""Annotations over REST: nothing is lost, nothing is silently overwritten, nothing is stored twice."""

from __future__ import annotations

import json
import uuid
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from threading import Barrier
from typing import Any

import pytest
from fastapi.testclient import TestClient

from tracker import HAND_JOINTS, load_annotations

FIRST = {"If-None-Match": "*"}


def points(x: float = 1.5) -> list[list[float]]:
    return [[x, 2.25, 2]] * 20 + [[0.0, 0.0, 0]]


def operation() -> str:
    return str(uuid.uuid4())


@pytest.fixture
def place(add_recording) -> str:
    """Address of one hand in one frame."""
    return f"/api/v1/sequences/{add_recording('waving')['id']}/annotations/cam0/1/right"


def put(client: TestClient, place: str, x: float, headers: dict[str, str], operation_id: str | None = None) -> Any:
    body = {"points": points(x), "operation_id": operation_id or operation()}
    return client.put(place, json=body, headers=headers)


def match(revision: int) -> dict[str, str]:
    return {"If-Match": f'"{revision}"'}


def test_what_was_stored_comes_back(client: TestClient, place: str) -> None:
    assert client.get(place).status_code == 404
    made = put(client, place, 3.125, FIRST)
    assert made.status_code == 200
    assert made.headers["etag"] == '"1"'
    found = client.get(place)
    assert found.json() == made.json()
    assert found.headers["etag"] == '"1"'
    assert found.json()["points"] == points(3.125)
    assert (found.json()["frame"], found.json()["camera"], found.json()["hand"]) == (1, "cam0", "right")
    assert found.json()["author"] == "local"


def test_a_change_needs_to_say_what_it_changes(client: TestClient, place: str) -> None:
    assert put(client, place, 1, {}).status_code == 428
    put(client, place, 1, FIRST)
    assert put(client, place, 2, {}).status_code == 428
    assert client.delete(place).status_code == 428
    assert client.get(place).json()["points"] == points(1)


def test_who_is_late_gets_the_other_version_and_overwrites_nothing(client: TestClient, place: str) -> None:
    put(client, place, 1, FIRST)
    theirs = put(client, place, 2, match(1))
    late = put(client, place, 3, match(1))
    assert late.status_code == 409
    assert set(late.json()) == {"error", "detail", "theirs"}
    assert late.json()["theirs"] == theirs.json()
    assert late.headers["etag"] == '"2"'
    assert put(client, place, 4, FIRST).json()["theirs"] == theirs.json()
    assert client.get(place).json() == theirs.json()
    assert put(client, place, 3, match(2)).json()["revision"] == 3


def test_changing_what_was_never_made_is_a_conflict_with_nothing(client: TestClient, place: str) -> None:
    answer = put(client, place, 1, match(1))
    assert (answer.status_code, answer.json()["theirs"]) == (409, None)


def test_a_repeated_operation_is_answered_alike_and_done_once(client: TestClient, place: str) -> None:
    first, second = operation(), operation()
    made = put(client, place, 1, FIRST, first)
    assert put(client, place, 1, FIRST, first).json() == made.json()
    changed = put(client, place, 2, match(1), second)
    put(client, place, 3, match(2))
    again = put(client, place, 2, match(1), second)  # its answer was lost, others went on meanwhile
    assert (again.status_code, again.json(), again.headers["etag"]) == (200, changed.json(), '"2"')
    assert put(client, place, 1, FIRST, first).json() == made.json()
    assert [item["revision"] for item in client.get(f"{place}/history").json()["items"]] == [3, 2, 1]


def test_an_operation_cannot_be_used_for_something_else(client: TestClient, place: str) -> None:
    used = operation()
    put(client, place, 1, FIRST, used)
    assert put(client, place, 2, match(1), used).status_code == 422
    assert put(client, place.replace("/1/", "/2/"), 1, FIRST, used).status_code == 422
    assert client.get(place.replace("/1/", "/2/")).status_code == 404
    assert client.get(place).json()["revision"] == 1


def test_a_hand_that_nobody_marked_has_an_empty_history(client: TestClient, place: str) -> None:
    answer = client.get(f"{place}/history")
    assert (answer.status_code, answer.json()["items"], answer.headers.get("etag")) == (200, [], None)
    nowhere = client.get(f"{place.replace('/cam0/', '/cam9/')}/history")
    assert nowhere.status_code in (404, 422)


def test_what_was_deleted_can_be_restored(client: TestClient, place: str) -> None:
    put(client, place, 1, FIRST)
    put(client, place, 2, match(1))
    assert client.delete(place, headers=match(1)).status_code == 409
    gone = client.delete(place, headers=match(2))
    assert (gone.status_code, gone.headers["etag"]) == (204, '"3"')
    assert client.get(place).status_code == 404
    assert client.delete(place, headers=match(3)).status_code == 404
    assert put(client, place, 9, match(2)).json()["theirs"] is None
    history = client.get(f"{place}/history")
    assert [item["act"] for item in history.json()["items"]] == ["delete", "put", "put"]
    assert history.headers["etag"] == '"3"'
    body = {"operation_id": operation()}
    url = f"{place}/history/1/restore"
    assert client.post(url, json=body, headers=match(2)).status_code == 409
    back = client.post(url, json=body, headers=match(3))
    assert (back.json()["revision"], back.json()["points"]) == (4, points(1))
    assert client.post(url, json=body, headers=match(3)).json() == back.json()
    assert client.get(place).json() == back.json()
    assert client.post(f"{place}/history/3/restore", json=body, headers=match(4)).status_code == 422
    assert client.post(f"{place}/history/9/restore", json=body, headers=match(4)).status_code == 404


def test_a_deleted_one_can_be_made_anew_and_its_revisions_go_on(client: TestClient, place: str) -> None:
    put(client, place, 1, FIRST)
    lost = {"operation_id": operation()}
    for _ in range(2):  # the answer to the first was lost
        assert client.delete(place, headers=match(1), params=lost).status_code == 204
    assert put(client, place, 5, FIRST).json()["revision"] == 3
    assert client.get(place).json()["points"] == points(5)


@pytest.mark.parametrize(
    "rows",
    [
        points()[:20],
        [*points(), [1, 2, 2]],
        [[float("nan"), 1, 2], *points()[1:]],
        [[float("inf"), 1, 2], *points()[1:]],
        [[1, 1, 3], *points()[1:]],
        [[1, 1, 1.5], *points()[1:]],
        [[1, 1], *points()[1:]],
        [["1", 1, 2], *points()[1:]],
        [[1000, 1, 2], *points()[1:]],
        [[1, -500, 1], *points()[1:]],
        [[1e300, 1, 0], *points()[1:]],
        None,
    ],
)
def test_points_that_make_no_sense_are_refused(client: TestClient, place: str, rows: Any) -> None:
    body = json.dumps({"points": rows, "operation_id": operation()})
    answer = client.put(place, content=body, headers=FIRST | {"Content-Type": "application/json"})
    assert (answer.status_code, set(answer.json())) == (422, {"error", "detail"})
    assert client.get(place).status_code == 404


def test_places_that_are_not_there_are_refused(client: TestClient, place: str) -> None:
    for wrong, status in (
        (place.replace("/1/", "/3/"), 404),
        (place.replace("/1/", "/-1/"), 422),
        (place.replace("cam0", "cam1"), 404),
        (place.replace("right", "third"), 422),
        (place.replace(place.split("/")[4], str(uuid.uuid4())), 404),
    ):
        assert put(client, wrong, 1, FIRST).status_code == status, wrong


def test_lists_can_be_narrowed_and_paged(client: TestClient, place: str) -> None:
    base = place.rsplit("/", 3)[0]
    for frame in (2, 0, 1):
        for hand in ("right", "left"):
            put(client, f"{base}/cam0/{frame}/{hand}", frame, FIRST)

    def keys(**params: Any) -> list[tuple[int, str]]:
        return [(item["frame"], item["hand"]) for item in client.get(base, params=params).json()["items"]]

    assert keys() == [(f, h) for f in range(3) for h in ("left", "right")]
    assert keys(**{"from": 1, "to": 1}) == [(1, "left"), (1, "right")]
    assert keys(camera="cam1") == []
    page = client.get(base, params={"limit": 4}).json()
    rest = client.get(base, params={"limit": 4, "cursor": page["next_cursor"]}).json()
    assert len(page["items"]) == 4
    assert [(item["frame"], item["hand"]) for item in rest["items"]] == [(2, "left"), (2, "right")]
    assert rest["next_cursor"] is None


def test_the_recording_counts_frames_that_are_annotated_now(client: TestClient, place: str) -> None:
    base = place.rsplit("/", 3)[0]
    recording = base.rsplit("/", 1)[0]
    for frame, hand in ((0, "right"), (0, "left"), (2, "right")):
        put(client, f"{base}/cam0/{frame}/{hand}", 1, FIRST)
    assert client.get(recording).json()["annotated_frames"] == 2
    client.delete(f"{base}/cam0/2/right", headers=match(1))
    assert client.get("/api/v1/sequences").json()["items"][0]["annotated_frames"] == 1


def test_the_file_is_what_the_tracker_reads(client: TestClient, place: str, tmp_path: Path) -> None:
    put(client, place, 4.5, FIRST)
    answer = client.get(place.rsplit("/", 3)[0] + ".json")
    assert answer.json()["joints"] == list(HAND_JOINTS)
    path = tmp_path / "annotations.json"
    path.write_bytes(answer.content)
    (item,) = load_annotations(path).items
    assert (item.key, item.points.tolist()) == ((1, "cam0", "right"), points(4.5))


def test_eight_at_once_win_one_revision_each_and_lose_nothing_from_the_history(client: TestClient, place: str) -> None:
    put(client, place, 0, FIRST)
    rounds, people = 4, 8
    together = Barrier(people)

    def work(person: int) -> list[tuple[int, float]]:
        mine = []
        for turn in range(rounds):
            together.wait()
            revision = client.get(place).json()["revision"]
            together.wait()
            x = 1 + person + turn / 8
            answer = put(client, place, x, match(revision))
            assert answer.status_code in (200, 409), answer.text
            if answer.status_code == 200:
                mine.append((answer.json()["revision"], x))
            else:
                assert answer.json()["theirs"]["revision"] > revision
        return mine

    with ThreadPoolExecutor(people) as pool:
        won = sorted(item for mine in pool.map(work, range(people)) for item in mine)
    assert [revision for revision, _ in won] == list(range(2, rounds + 2))
    history = client.get(f"{place}/history").json()["items"]
    assert [(item["revision"], item["points"][0][0]) for item in history[::-1][1:]] == won
    assert client.get(place).json()["points"] == history[0]["points"]


def test_of_eight_who_make_the_first_at_once_one_wins(client: TestClient, place: str) -> None:
    together = Barrier(8)

    def work(person: int) -> int:
        together.wait()
        return put(client, place, person, FIRST).status_code

    with ThreadPoolExecutor(8) as pool:
        assert sorted(pool.map(work, range(8))) == [200] + [409] * 7
    assert len(client.get(f"{place}/history").json()["items"]) == 1


def test_one_operation_sent_eight_times_at_once_is_done_once(client: TestClient, place: str) -> None:
    together, same = Barrier(8), operation()

    def work(_: int) -> Any:
        together.wait()
        answer = put(client, place, 1, FIRST, same)
        return answer.status_code, answer.json()["revision"]

    with ThreadPoolExecutor(8) as pool:
        assert set(pool.map(work, range(8))) == {(200, 1)}
    assert len(client.get(f"{place}/history").json()["items"]) == 1
