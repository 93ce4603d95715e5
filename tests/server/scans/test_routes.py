"""`/scans`: uploads, crops, and what the browser draws."""

from __future__ import annotations

import io
import json
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from server.scans.cropping import find_inside
from server.scans.geometry import CROPPED, LEFT_OUT, pack_arrays
from tests.server.conftest import Studio
from tests.server.curation import API, make_ball, send_scans
from tests.server.packed_arrays import unpack_arrays
from tests.server.teams.conftest import Join, join
from tracker.capture.scan import save_scan

__all__ = ["join"]

IDENTITY = [float(i == j) for i in range(4) for j in range(4)]


def write(tmp_path: Path, scan: Any, name: str = "a.ply") -> bytes:
    save_scan(scan, tmp_path / name)
    return (tmp_path / name).read_bytes()


@pytest.fixture
def ball(studio: Studio, tmp_path: Path) -> dict[str, Any]:
    """A scan in the studio."""
    return send_scans(studio, {"ball.ply": write(tmp_path, make_ball())}).json()["added"][0]


def crop(studio: Studio, scan: dict[str, Any], *strokes: dict[str, Any], revision: int = 1, **more: Any) -> Any:
    headers = {"If-Match": f'"{revision}"'}
    return studio.client.put(f"{API}/scans/{scan['id']}/crop", json={"strokes": list(strokes), **more}, headers=headers)


def fetch(studio: Studio, scan: dict[str, Any], size: int = 20_000) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
    answer = studio.client.get(f"{API}/scans/{scan['id']}/geometry/{scan['geometry_key']}", params={"size": size})
    assert answer.status_code == 200, answer.text
    assert "immutable" in answer.headers["cache-control"]
    return unpack_arrays(answer.content)


def test_a_zip_with_its_list_becomes_scans_and_each_bad_file_is_named(studio: Studio, tmp_path: Path) -> None:
    lines = [
        {"file": "one.ply", "subject": "Ada", "pose": "fist", "side": "left"},
        {"file": "two.ply", "subject": "Bob", "metres_per_unit": 0.001},
        {"file": "gone.ply"},
    ]
    far = make_ball(2, radius=80.0)
    empty = (
        b"ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
    )
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        archive.writestr("hands/scans.json", json.dumps({"scans": lines}))
        archive.writestr("hands/one.ply", write(tmp_path, make_ball(1)))
        archive.writestr("hands/two.ply", write(tmp_path, far))
        archive.writestr("hands/huge.ply", write(tmp_path, make_ball(3, radius=20_000.0)))
        archive.writestr("hands/empty.ply", empty)
        archive.writestr("hands/junk.obj", b"v nan nan nan\n")
        archive.writestr("hands/truth.npz", b"not a scan")
    answer = send_scans(studio, {"hands.zip": packed.getvalue()}, collection="Lab")
    assert answer.status_code == 201, answer.text
    done = answer.json()
    found = {item["name"]: item for item in done["added"]}
    assert set(found) == {"hands/one", "hands/two"}
    one, two = found["hands/one"], found["hands/two"]
    assert (one["collection"], one["subject"], one["pose"], one["side"]) == ("Lab", "Ada", "fist", "left")
    assert two["extent_m"] == pytest.approx([0.16] * 3, abs=0.002)
    refused = {item["file"]: item["detail"] for item in done["refused"]}
    assert set(refused) == {"hands/huge.ply", "hands/empty.ply", "hands/junk.obj"}
    assert "size" in refused["hands/huge.ply"] and str(studio.settings.data_dir) not in answer.text
    assert any("gone.ply" in note for note in done["notes"]) and any("1 other" in note for note in done["notes"])
    assert not any((studio.settings.data_dir / "scan_uploads").iterdir())


def test_the_same_file_sent_again_is_kept_once(studio: Studio, tmp_path: Path) -> None:
    data = write(tmp_path, make_ball())
    first = send_scans(studio, {"a.ply": data}).json()["added"][0]
    again = send_scans(studio, {"b.ply": data}).json()
    assert again["added"] == [] and [item["id"] for item in again["known"]] == [first["id"]]
    assert len(list((studio.settings.data_dir / "scans").iterdir())) == 1
    assert send_scans(studio, {"a.ply": data}, collection="another").json()["added"]


@pytest.mark.parametrize(
    ("files", "options"),
    [
        ({"readme.txt": b"hello"}, {}),
        ({"a.zip": b"PK no zip"}, {}),
        ({"../../evil.ply": b"ply"}, {}),
        ({"a.ply": b"ply", "scans.json": b"["}, {}),
        ({"a.ply": b"ply", "scans.json": b'[{"file": 3}]'}, {}),
        ({"a.ply": b"ply", "scans.json": b'{"scans": 7}'}, {}),
        ({"a.ply": b"ply"}, {"side": "both"}),
        ({"a.ply": b"ply"}, {"metres_per_unit": 0}),
        ({"a.ply": b"ply"}, {"collection": ""}),
        ({"a.ply": b"ply"}, {"strange": 1}),
    ],
)
def test_uploads_that_make_no_sense_are_refused_whole(
    studio: Studio, files: dict[str, bytes], options: dict[str, Any]
) -> None:
    answer = send_scans(studio, files, **options)
    assert answer.status_code == 422, answer.text
    assert studio.client.get(f"{API}/scans").json()["items"] == []


def test_more_than_the_settings_allow_is_not_read(studio: Studio) -> None:
    studio.app.state.settings = studio.settings.model_copy(update={"max_upload_bytes": 1000})
    assert send_scans(studio, {"a.ply": b"x" * 5000}).status_code == 413
    assert send_scans(studio, {"a.ply": b"x" * 2_000_000}).status_code == 413


def test_scans_are_listed_by_what_one_asks_and_none_twice(studio: Studio, tmp_path: Path) -> None:
    for number in range(5):
        subject = "Ada" if number % 2 else "Bob"
        send_scans(studio, {f"s{number}.ply": write(tmp_path, make_ball(number))}, subject=subject, collection="Lab")
    names, cursor = [], None
    while True:
        page = studio.client.get(f"{API}/scans", params={"limit": 2} | ({"cursor": cursor} if cursor else {})).json()
        names += [item["name"] for item in page["items"]]
        cursor = page["next_cursor"]
        if cursor is None:
            break
    assert names == ["s4", "s3", "s2", "s1", "s0"]
    asked = studio.client.get(f"{API}/scans", params={"subject": "Ada", "state": "new"}).json()["items"]
    assert [item["name"] for item in asked] == ["s3", "s1"]
    [collection] = studio.client.get(f"{API}/scans/collections").json()["items"]
    people = {"subjects": 2, "subject_names": ["Ada", "Bob"]}
    assert collection == {"name": "Lab", "scans": 5, **people, "registered": 0, "failed": 0}


def test_a_deleted_scan_comes_back_as_it_was(studio: Studio, ball: dict[str, Any]) -> None:
    assert studio.client.delete(f"{API}/scans/{ball['id']}").status_code == 204
    assert studio.client.get(f"{API}/scans/{ball['id']}").status_code == 404
    assert studio.client.post(f"{API}/scans/{ball['id']}/restore").json() == ball


def test_the_browser_gets_the_points_to_a_few_micrometres_and_fewer_are_a_part_of_more(
    studio: Studio, ball: dict[str, Any]
) -> None:
    arrays, facts = fetch(studio, ball)
    points = np.array(facts["origin_m"]) + np.array(facts["step_m"]) * arrays["positions"]
    assert facts["point_count"] == len(points) == 2000
    assert np.abs(np.linalg.norm(points, axis=1) - 0.08).max() < 5e-6
    assert np.abs(arrays["normals"] / 127.0 - points / 0.08).max() < 0.01
    fewer, scale = fetch(studio, ball, size=100)
    some = np.array(scale["origin_m"]) + np.array(scale["step_m"]) * fewer["positions"]
    assert np.abs(some - points[:100]).max() < 5e-6


def test_what_was_packed_comes_back_and_lies_at_multiples_of_eight() -> None:
    rng = np.random.default_rng(0)
    arrays = {
        "bytes": rng.integers(0, 255, (3, 3), dtype=np.uint8),
        "floats": rng.normal(size=(5,)).astype(np.float32),
        "none": np.zeros((0, 3), np.uint32),
    }
    data = pack_arrays(arrays, {"side": "left"})
    back, facts = unpack_arrays(data)
    assert facts == {"side": "left"} and list(back) == list(arrays)
    for name, array in arrays.items():
        np.testing.assert_array_equal(back[name], array)
    assert int.from_bytes(data[4:8], "little") % 8 == 0


def test_a_plane_and_a_drawn_line_take_points_away_and_the_file_stays(studio: Studio, ball: dict[str, Any]) -> None:
    before = studio.client.get(f"{API}/scans/{ball['id']}/file").content
    plane = {"kind": "plane", "normal": [0, 0, 1], "offset": 0.04}
    view = [*np.diag([10.0, 10.0, 1.0, 1.0]).ravel()]
    square = {"kind": "polygon", "corners": [[-0.4, -0.4], [0.4, -0.4], [0.4, 0.4], [-0.4, 0.4]], "view": view}
    answer = crop(studio, ball, plane, square)
    assert answer.status_code == 200, answer.text
    cropped = answer.json()
    assert (cropped["revision"], answer.headers["etag"]) == (2, '"2"')
    assert cropped["geometry_key"] != ball["geometry_key"]
    arrays, facts = fetch(studio, cropped)
    points = np.array(facts["origin_m"]) + np.array(facts["step_m"]) * arrays["positions"]
    expected = (points[:, 2] > 0.04) | (np.abs(points[:, :2]).max(axis=1) < 0.04)
    np.testing.assert_array_equal(arrays["flags"] == CROPPED, expected)
    assert cropped["removed_count"] == expected.sum()
    assert not fetch(studio, ball)[0]["flags"].any(), "the address of before still shows the whole"
    assert studio.client.get(f"{API}/scans/{ball['id']}/file").content == before
    back = crop(studio, ball, revision=2).json()
    assert (back["revision"], back["removed_count"]) == (3, 0)
    history = studio.client.get(f"{API}/scans/{ball['id']}/crop/history").json()["items"]
    assert [(item["revision"], len(item["strokes"])) for item in history] == [(3, 0), (2, 2), (1, 0)]


def test_points_behind_the_camera_stay(studio: Studio, ball: dict[str, Any]) -> None:
    looks_along_z = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0]
    everywhere = {"kind": "polygon", "corners": [[-9, -9], [9, -9], [9, 9], [-9, 9]], "view": looks_along_z}
    cropped = crop(studio, ball, everywhere).json()
    arrays, facts = fetch(studio, cropped)
    points = np.array(facts["origin_m"]) + np.array(facts["step_m"]) * arrays["positions"]
    assert (arrays["flags"][points[:, 2] < 0] == 0).all()
    assert (arrays["flags"][points[:, 2] > 0.02] == CROPPED).all()


def test_who_crops_an_older_revision_is_told_the_newer_one(studio: Studio, ball: dict[str, Any]) -> None:
    plane = {"kind": "plane", "normal": [0, 0, 1], "offset": 0.0}
    assert crop(studio, ball, plane).status_code == 200
    late = crop(studio, ball, revision=1)
    assert (late.status_code, late.json()["theirs"]["revision"], late.headers["etag"]) == (409, 2, '"2"')
    address = f"{API}/scans/{ball['id']}/crop"
    assert studio.client.put(address, json={"strokes": []}).status_code == 428
    assert studio.client.get(address).json()["strokes"] == [plane]


@pytest.mark.parametrize(
    "stroke",
    [
        {"kind": "plane", "normal": [0, 0, 0], "offset": 0},
        {"kind": "plane", "normal": [0, 0, 1], "offset": -1},  # leaves nothing
        {"kind": "polygon", "corners": [[0, 0], [1, 1]], "view": IDENTITY},
        {"kind": "polygon", "corners": [[0, 0], [1, 1], [1, 0]], "view": IDENTITY[:15]},
        {"kind": "polygon", "corners": [[0, 0], [1e300, 1], [1, 0]], "view": IDENTITY},
        {"kind": "sphere"},
    ],
)
def test_crops_that_cannot_be_are_refused(studio: Studio, ball: dict[str, Any], stroke: dict[str, Any]) -> None:
    assert crop(studio, ball, stroke).status_code == 422
    assert studio.client.get(f"{API}/scans/{ball['id']}").json() == ball


def test_too_many_corners_are_refused_before_anybody_waits_for_them(studio: Studio, ball: dict[str, Any]) -> None:
    stroke = {"kind": "polygon", "corners": [[0.0, 0.0]] * 2000, "view": IDENTITY}
    assert "corners" in crop(studio, ball, *[stroke] * 6).json()["detail"]


def test_green_points_are_an_objects_unless_one_says_otherwise(studio: Studio, tmp_path: Path) -> None:
    scan = make_ball()
    is_green = scan.points[:, 0] > 0.05
    colors = np.where(is_green[:, None], [30, 200, 40], [200, 150, 120]).astype(np.uint8)
    added = send_scans(studio, {"a.ply": write(tmp_path, make_ball(colors=colors))}).json()["added"][0]
    assert added["removed_count"] == is_green.sum() and added["has_colors"]
    arrays, _ = fetch(studio, added)
    np.testing.assert_array_equal(arrays["flags"] == LEFT_OUT, arrays["colors"][:, 1] == 200)
    assert crop(studio, added, drops_objects=False).json()["removed_count"] == 0


def test_the_inside_of_a_line_is_found_as_by_counting_crossings() -> None:
    rng = np.random.default_rng(3)
    corners, points = rng.uniform(-1, 1, (40, 2)), rng.uniform(-1, 1, (300, 2))
    ends = np.roll(corners, -1, axis=0)
    for point, found in zip(points, find_inside(points, corners), strict=True):
        crossings = sum(
            (y0 > point[1]) != (y1 > point[1]) and point[0] < x0 + (point[1] - y0) * (x1 - x0) / (y1 - y0)
            for (x0, y0), (x1, y1) in zip(corners, ends, strict=True)
        )
        assert found == crossings % 2


def test_annotators_crop_but_do_not_upload(studio: Studio, ball: dict[str, Any], join: Join, tmp_path: Path) -> None:
    ann = join("ann")
    plane = {"kind": "plane", "normal": [0, 0, 1], "offset": 0.0}
    assert ann.send("PUT", f"/scans/{ball['id']}/crop", {"strokes": [plane]}, revision=1).status_code == 200
    headers = {"Authorization": f"Bearer {ann.secret}"}
    answer = send_scans(studio, {"b.ply": write(tmp_path, make_ball(9))}, headers=headers)
    assert answer.status_code == 403
