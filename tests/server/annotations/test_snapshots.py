"""Snapshots never change, are found by their hash, and can be made the current labels again."""

from __future__ import annotations

import hashlib
import json
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

from tests.server.conftest import AddRecording, Studio
from tests.server.exchange.labels import API, get_labels, make_points, put
from tracker import load_annotations


def snapshot(studio: Studio, sequence: dict[str, Any], name: str = "first") -> dict[str, Any]:
    answer = studio.client.post(f"{API}/sequences/{sequence['id']}/labels/snapshots", json={"name": name})
    assert answer.status_code in (200, 201), answer.text
    return answer.json() | {"is_new": answer.status_code == 201}


def test_a_snapshot_keeps_the_labels_and_its_hash_is_that_of_its_file(
    studio: Studio, add_recording: AddRecording, tmp_path: Path
) -> None:
    sequence = add_recording()
    put(studio.client, sequence, 0, make_points())
    made = snapshot(studio, sequence, "  before the review ")
    assert (made["version"], made["name"], made["item_count"], made["joint_count"]) == (1, "before the review", 1, 21)
    put(studio.client, sequence, 0, make_points(12.0))
    file = studio.client.get(f"{API}/snapshots/{made['id']}/labels.json")
    assert hashlib.sha256(file.content).hexdigest() == made["content_hash"]
    assert file.headers["ETag"] == f'"{made["content_hash"]}"'
    (tmp_path / "annotations.json").write_bytes(file.content)
    (item,) = load_annotations(tmp_path / "annotations.json").items
    assert item.points.tolist() == make_points()


def test_the_same_labels_are_kept_once(studio: Studio, add_recording: AddRecording) -> None:
    sequence, other = add_recording(), add_recording("other")
    put(studio.client, sequence, 0, make_points())
    first = snapshot(studio, sequence)
    again = snapshot(studio, sequence, "second")
    assert (again["id"], again["name"], again["is_new"]) == (first["id"], "first", False)
    put(studio.client, sequence, 0, make_points(11.0))
    put(studio.client, sequence, 0, make_points())
    assert snapshot(studio, sequence)["id"] == first["id"]
    put(studio.client, other, 0, make_points())
    elsewhere = snapshot(studio, other)
    assert elsewhere["is_new"] and elsewhere["content_hash"] == first["content_hash"]


def test_snapshots_made_at_once_count_on(studio: Studio, add_recording: AddRecording) -> None:
    sequence = add_recording()

    def work(frame: int) -> dict[str, Any]:
        put(studio.client, sequence, frame % 3, make_points(5.0 + frame), ("right", "left")[frame // 3])
        return snapshot(studio, sequence, f"after {frame}")

    with ThreadPoolExecutor(6) as pool:
        made = list(pool.map(work, range(6)))
    listed = studio.client.get(f"{API}/sequences/{sequence['id']}/labels/snapshots").json()["items"]
    assert [item["version"] for item in listed] == list(range(len(listed), 0, -1))
    assert {item["id"] for item in listed} == {item["id"] for item in made}


def test_snapshots_are_listed_newest_first_in_pages(studio: Studio, add_recording: AddRecording) -> None:
    sequence = add_recording()
    for number in range(3):
        put(studio.client, sequence, 0, make_points(number))
        snapshot(studio, sequence, f"number {number}")
    address = f"{API}/sequences/{sequence['id']}/labels/snapshots?limit=2"
    first = studio.client.get(address).json()
    rest = studio.client.get(f"{address}&cursor={first['next_cursor']}").json()
    assert [item["version"] for item in first["items"] + rest["items"]] == [3, 2, 1]
    assert rest["next_cursor"] is None


def test_two_states_are_compared_joint_by_joint(studio: Studio, add_recording: AddRecording) -> None:
    sequence = add_recording()
    put(studio.client, sequence, 0, make_points())
    put(studio.client, sequence, 1, make_points())
    first = snapshot(studio, sequence)
    moved = make_points()
    moved[3] = [moved[3][0] + 3, moved[3][1] + 4, 2]
    moved[4][2] = 1
    moved[5] = [0, 0, 0]
    put(studio.client, sequence, 0, moved)
    put(studio.client, sequence, 2, make_points(), "left")
    address = f"{API}/sequences/{sequence['id']}/annotations/cam0/1/right"
    studio.client.delete(address, headers={"If-Match": '"1"'})
    now = studio.client.get(f"{API}/snapshots/{first['id']}/compare").json()
    assert (now["hands_added"], now["hands_removed"], now["hands_changed"]) == (1, 1, 1)
    assert (now["joints_added"], now["joints_removed"], now["joints_moved"], now["joints_restated"]) == (21, 22, 1, 1)
    assert now["max_shift_px"] == now["mean_shift_px"] == 5.0
    changed = now["items"][0]
    assert changed["joints_moved"] == {"thumb_ip": 5.0}
    assert (changed["joints_restated"], changed["joints_removed"]) == (["thumb_tip"], ["index_mcp"])
    second = snapshot(studio, sequence, "second")
    back = studio.client.get(f"{API}/snapshots/{second['id']}/compare?with={first['id']}").json()
    assert (back["hands_added"], back["hands_removed"], back["joints_added"]) == (1, 1, 22)
    same = studio.client.get(f"{API}/snapshots/{second['id']}/compare?with=now").json()
    assert same["items"] == [] and same["max_shift_px"] is None


def test_a_restore_makes_revisions_and_can_be_undone(studio: Studio, add_recording: AddRecording) -> None:
    sequence = add_recording()
    put(studio.client, sequence, 0, make_points())
    first = snapshot(studio, sequence)
    put(studio.client, sequence, 0, make_points(12.0))
    put(studio.client, sequence, 1, make_points(13.0), "left")
    later = get_labels(studio.client, sequence)

    done = studio.client.post(f"{API}/snapshots/{first['id']}/restore").json()
    assert (done["changed"], done["deleted"]) == (1, 1)
    assert get_labels(studio.client, sequence) == {(0, "right"): make_points()}
    address = f"{API}/sequences/{sequence['id']}/annotations/cam0"
    history = studio.client.get(f"{address}/0/right/history").json()["items"]
    assert [(item["revision"], item["act"]) for item in history] == [(3, "restore"), (2, "put"), (1, "put")]
    deleted = studio.client.get(f"{address}/1/left/history").json()["items"]
    assert [item["act"] for item in deleted] == ["delete", "put"]

    undone = studio.client.post(f"{API}/snapshots/{done['before']['id']}/restore").json()
    assert (undone["changed"], undone["deleted"]) == (2, 0)
    assert get_labels(studio.client, sequence) == later
    again = studio.client.post(f"{API}/snapshots/{undone['before']['id']}/restore").json()
    assert undone["before"]["id"] == first["id"] and again["changed"] == 1


def test_a_damaged_snapshot_says_so_and_is_not_used(studio: Studio, add_recording: AddRecording) -> None:
    sequence = add_recording()
    put(studio.client, sequence, 0, make_points())
    made = snapshot(studio, sequence)
    address = f"{API}/snapshots/{made['id']}"
    assert studio.client.get(f"{address}/verify").json() == {
        "is_intact": True,
        "expected": made["content_hash"],
        "found": made["content_hash"],
    }
    path = studio.settings.data_dir / "snapshots" / f"{made['id']}.json"
    data = path.read_bytes()
    path.write_bytes(data.replace(b"10.0", b"11.0"))
    checked = studio.client.get(f"{address}/verify").json()
    assert checked["is_intact"] is False and checked["found"] not in (None, made["content_hash"])
    for method, tail in (("GET", "labels.json"), ("GET", "compare"), ("POST", "restore")):
        answer = studio.client.request(method, f"{address}/{tail}")
        assert answer.status_code == 409
        assert answer.json()["error"] == "DamagedSnapshotError" and "is damaged" in answer.json()["detail"]
    export = studio.client.get(
        f"{API}/sequences/{sequence['id']}/labels/export", params={"format": "annotations", "snapshot_id": made["id"]}
    )
    assert export.status_code == 409
    assert get_labels(studio.client, sequence) == {(0, "right"): make_points()}
    path.unlink()
    assert studio.client.get(f"{address}/verify").json()["found"] is None
    assert "is missing" in studio.client.get(f"{address}/labels.json").json()["detail"]


def test_a_snapshot_of_another_recording_or_none_is_refused(studio: Studio, add_recording: AddRecording) -> None:
    one, other = add_recording(), add_recording("other")
    a = snapshot(studio, one)
    put(studio.client, other, 0, make_points())
    b = snapshot(studio, other)
    assert studio.client.get(f"{API}/snapshots/{a['id']}/compare?with={b['id']}").status_code == 422
    params = {"format": "annotations", "snapshot_id": b["id"]}
    assert studio.client.get(f"{API}/sequences/{one['id']}/labels/export", params=params).status_code == 422
    assert studio.client.get(f"{API}/snapshots/{one['id']}").status_code == 404
    nameless = studio.client.post(f"{API}/sequences/{one['id']}/labels/snapshots", json={"name": " "})
    assert nameless.status_code == 422


def test_every_format_can_be_made_from_a_snapshot(studio: Studio, add_recording: AddRecording) -> None:
    sequence = add_recording()
    put(studio.client, sequence, 0, make_points())
    made = snapshot(studio, sequence)
    put(studio.client, sequence, 0, make_points(12.0))
    address = f"{API}/sequences/{sequence['id']}/labels/export"
    for name in ("annotations", "coco_keypoints", "coco_wholebody", "deeplabcut", "t16"):
        params = {"format": name, "snapshot_id": made["id"]}
        old = studio.client.get(address, params=params)
        assert old.status_code == 200, old.text
        assert old.content == studio.client.get(address, params=params).content
        assert old.content != studio.client.get(address, params={"format": name}).content
    old = studio.client.get(address, params={"format": "annotations", "snapshot_id": made["id"]})
    assert json.loads(old.content)["items"][0]["points"][0][0] == 10.0
