"""Imports over REST: checked, reported, moved in whole or not at all."""

from __future__ import annotations

import io
import json
import os
import time
import uuid
import zipfile
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from datetime import timedelta
from pathlib import Path
from typing import Any

import pytest
from fastapi.testclient import TestClient
from sqlalchemy import select, update

from server.access.models import LOCAL_ACCOUNT_ID
from server.app import create_app
from server.database import utc_now
from server.imports.models import ImportRow
from server.imports.service import ImportContext, import_recording, propose_name
from server.settings import Settings
from tests.server.conftest import BASE_URL, Studio
from tracker import HAND_JOINTS, ImportRefusedError


def parts_of(folder: Path, top: str = "") -> list[tuple[str, tuple[str, bytes]]]:
    """A folder as a browser sends it."""
    return [
        ("files", (top + path.relative_to(folder).as_posix(), path.read_bytes()))
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    ]


def upload(client: TestClient, parts: list[Any], **options: Any) -> Any:
    data = {"options": json.dumps(options)} if options else None
    return client.post("/api/v1/imports", files=parts, data=data)


def pack(entries: dict[str, bytes]) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as file:
        for name, data in entries.items():
            file.writestr(name, data)
    return buffer.getvalue()


def left_behind(studio: Studio) -> list[Path]:
    return [path for area in ("uploads", "sequences") for path in (studio.settings.data_dir / area).glob("*")]


def test_a_dropped_folder_becomes_a_recording(studio: Studio, make_recording) -> None:
    client, folder = studio.client, make_recording("waving", frames=3)
    made = upload(client, parts_of(folder, "my take/"))
    assert made.status_code == 201
    found = made.json()
    assert (found["state"], found["name"], found["sequence_id"]) == ("checked", "my take", None)
    assert found["report"]["ok"] and found["report"]["frame_count"] == 3
    assert found["file_count"] == 7
    assert client.get(f"/api/v1/imports/{found['id']}").json() == found
    assert client.get("/api/v1/sequences").json()["items"] == []
    stored = client.post(f"/api/v1/imports/{found['id']}/confirm", json={"name": "chosen"})
    assert stored.status_code == 201
    assert (stored.json()["name"], stored.json()["frame_count"]) == ("chosen", 3)
    assert client.get("/api/v1/sequences").json()["items"] == [stored.json()]
    assert client.get(f"/api/v1/imports/{found['id']}").json()["sequence_id"] == stored.json()["id"]
    assert [path.name for path in left_behind(studio)] == [stored.json()["id"]]


def test_a_zip_becomes_a_recording(client: TestClient, make_recording) -> None:
    folder = make_recording("waving")
    data = pack({f"waving/{name}": content for _, (name, content) in parts_of(folder)})
    found = upload(client, [("files", ("Take 7.zip", data))]).json()
    assert (found["state"], found["name"]) == ("checked", "Take 7")
    assert client.post(f"/api/v1/imports/{found['id']}/confirm", json={}).json()["name"] == "Take 7"


def test_what_files_do_not_tell_can_be_told_later(studio: Studio, make_recording) -> None:
    client, folder = studio.client, make_recording("bare", color=None)
    (folder / "sequence.json").unlink()
    found = upload(client, parts_of(folder)).json()
    assert found["state"] == "refused"
    assert found["report"]["problems"]
    assert str(studio.settings.data_dir) not in json.dumps(found)
    url = f"/api/v1/imports/{found['id']}"
    assert client.post(f"{url}/confirm", json={}).status_code == 409
    told = {"format": "rgbd_folder", "fx": 32.0, "fy": 32.0, "cx": 16, "cy": 12, "depth_scale": 0.001, "fps": 15}
    again = client.post(f"{url}/check", json={"options": told})
    assert again.json()["state"] == "checked", again.text
    stored = client.post(f"{url}/confirm", json={"name": "bare hand"}).json()
    assert (stored["fps"], stored["cameras"][0]["has_color"]) == (15.0, False)
    assert client.post(f"{url}/check", json={"options": told}).status_code == 409


def test_confirming_twice_gives_the_same_recording(studio: Studio, make_recording) -> None:
    client = studio.client
    found = upload(client, parts_of(make_recording())).json()
    url = f"/api/v1/imports/{found['id']}/confirm"
    with ThreadPoolExecutor(4) as pool:
        answers = list(pool.map(lambda _: client.post(url, json={}), range(4)))
    assert {answer.status_code for answer in answers} == {201}
    assert len({answer.json()["id"] for answer in answers}) == 1
    assert len(left_behind(studio)) == 1


def test_annotations_come_along_with_their_recording(client: TestClient, make_recording) -> None:
    folder = make_recording("marked")
    rows = [[4.5, 3.0, 2]] * 21
    items = [{"frame": frame, "camera": "cam0", "hand": "right", "points": rows} for frame in (0, 2)]
    (folder / "annotations.json").write_text(json.dumps({"version": 1, "joints": HAND_JOINTS, "items": items}))
    document = json.loads((folder / "sequence.json").read_text()) | {"annotations": "annotations.json"}
    (folder / "sequence.json").write_text(json.dumps(document))
    found = upload(client, parts_of(folder)).json()
    stored = client.post(f"/api/v1/imports/{found['id']}/confirm", json={}).json()
    assert stored["annotated_frames"] == 2
    url = f"/api/v1/sequences/{stored['id']}/annotations"
    assert [item["points"] for item in client.get(url).json()["items"]] == [rows, rows]
    (first,) = client.get(f"{url}/cam0/2/right/history").json()["items"]
    assert (first["act"], first["revision"]) == ("import", 1)
    body = {"points": [[1, 1, 1]] * 21, "operation_id": str(uuid.uuid4())}
    assert client.put(f"{url}/cam0/2/right", json=body, headers={"If-Match": '"1"'}).json()["revision"] == 2


@pytest.mark.parametrize(
    "name",
    [
        "../evil.png",
        "a/../../evil.png",
        "/etc/evil.png",
        "a\\b.png",
        "c:evil.png",
        "a//b.png",
        "a/./b.png",
        "nul.txt",
        "x" * 300,
        "a/" * 13 + "b.png",
        "trailing. ",
        "bidi\u202egnp.exe",
    ],
)
def test_names_with_tricks_are_refused_and_nothing_is_kept(studio: Studio, name: str) -> None:
    answer = upload(studio.client, [("files", ("good.png", b"x")), ("files", (name, b"x"))])
    assert (answer.status_code, set(answer.json())) == (422, {"error", "detail"})
    assert left_behind(studio) == []
    assert not list(studio.settings.data_dir.parent.rglob("evil*"))


def test_names_that_mean_the_same_file_are_refused(studio: Studio) -> None:
    for names in (("a.png", "A.PNG"), ("a", "a/b"), ("a/b", "a")):
        answer = upload(studio.client, [("files", (name, b"x")) for name in names])
        assert answer.status_code == 422, names
    assert left_behind(studio) == []


@pytest.mark.parametrize(
    "entries",
    [{"../evil.png": b"x"}, {"/evil.png": b"x"}, {"bomb.bin": bytes(64 * 1024 * 1024)}, {"a\\evil.png": b"x"}],
)
def test_archives_with_tricks_are_refused_and_nothing_is_kept(studio: Studio, entries: dict[str, bytes]) -> None:
    answer = upload(studio.client, [("files", ("recording.zip", pack(entries)))])
    assert (answer.status_code, answer.json()["error"]) == (422, "ImportRefusedError")
    assert left_behind(studio) == []


@pytest.mark.parametrize(
    "options", ["{", "[]", '"x"', '{"fx": "wide"}', '{"depth_pattern": 3}', '{"unknown": 1}', "[" * 9999]
)
def test_options_that_make_no_sense_are_refused(studio: Studio, options: str) -> None:
    answer = studio.client.post("/api/v1/imports", files=[("files", ("a.png", b"x"))], data={"options": options})
    assert (answer.status_code, set(answer.json())) == (422, {"error", "detail"})
    assert left_behind(studio) == []


def test_a_body_that_is_no_upload_is_refused(studio: Studio) -> None:
    whole = b'--b\r\nContent-Disposition: form-data; name="files"; filename="a.png"\r\n\r\nx\r\n--b--\r\n'
    kind = {"Content-Type": "multipart/form-data; boundary=b"}
    assert studio.client.post("/api/v1/imports", content=whole, headers=kind).status_code == 201
    studio.client.delete(f"/api/v1/imports/{left_behind(studio)[0].name}")
    for body, headers in (
        (whole[:-8], kind),
        (whole, {"Content-Type": "application/json"}),
        (whole, {"Content-Type": "multipart/form-data"}),
        (whole.replace(b"--b", b"--c"), kind),
        (b"--b--\r\n", kind),
        (b"", kind),
        (whole.replace(b"a.png", b"\xff\xfe"), kind),
        (whole.replace(b"; filename=", b"; x=") + b"", kind),
    ):
        answer = studio.client.post("/api/v1/imports", content=body, headers=headers)
        assert (answer.status_code, set(answer.json())) == (422, {"error", "detail"}), body
    assert left_behind(studio) == []


def test_an_upload_is_forgotten_when_it_is_dropped(studio: Studio, make_recording) -> None:
    found = upload(studio.client, parts_of(make_recording())).json()
    url = f"/api/v1/imports/{found['id']}"
    assert studio.client.delete(url).status_code == 204
    assert studio.client.get(url).status_code == 404
    assert studio.client.delete(url).status_code == 404
    assert left_behind(studio) == []


@pytest.fixture
def tight(settings: Settings) -> Iterator[Studio]:
    """A studio that takes 4 files and 1000 bytes."""
    settings = settings.model_copy(update={"max_upload_files": 4, "max_upload_bytes": 1000})
    app = create_app(settings)
    with TestClient(app, base_url=BASE_URL, raise_server_exceptions=False) as client:
        yield Studio(app, client, settings)


def test_more_than_the_settings_allow_is_refused_and_nothing_is_kept(tight: Studio) -> None:
    def stream() -> Iterator[bytes]:  # without a Content-Length
        yield b'--b\r\nContent-Disposition: form-data; name="files"; filename="a.png"\r\n\r\n'
        for _ in range(100):
            yield bytes(100)

    kind = {"Content-Type": "multipart/form-data; boundary=b"}
    assert tight.client.post("/api/v1/imports", content=stream(), headers=kind).status_code == 413
    assert upload(tight.client, [("files", ("a", bytes(600))), ("files", ("b", bytes(600)))]).status_code == 413
    assert upload(tight.client, [("files", (f"{n}", b"x")) for n in range(5)]).status_code == 413
    packed = pack({"a": os.urandom(300), "b": bytes(5000)})
    assert upload(tight.client, [("files", ("a.zip", packed))]).status_code == 422
    assert left_behind(tight) == []


def test_uploads_nobody_confirmed_are_removed_when_the_studio_starts(studio: Studio, make_recording, settings) -> None:
    client = studio.client
    old = upload(client, parts_of(make_recording("old"))).json()["id"]
    new = upload(client, parts_of(make_recording("new"))).json()["id"]
    cut_off = studio.settings.data_dir / "uploads" / str(uuid.uuid4())
    arriving = studio.settings.data_dir / "uploads" / str(uuid.uuid4())
    cut_off.mkdir()
    arriving.mkdir()
    days_ago = time.time() - 3 * 86400
    os.utime(cut_off, (days_ago, days_ago))
    with studio.database.writing() as session:
        long_ago = utc_now() - timedelta(days=3)
        session.execute(update(ImportRow).where(ImportRow.id == uuid.UUID(old)).values(updated_at=long_ago))
    with TestClient(create_app(settings), base_url=BASE_URL) as restarted:
        assert restarted.get(f"/api/v1/imports/{old}").status_code == 404
        assert restarted.get(f"/api/v1/imports/{new}").status_code == 200
    assert {path.name for path in left_behind(studio)} == {new, arriving.name}


def test_a_recording_whose_rows_cannot_be_stored_leaves_no_files(studio: Studio, make_recording) -> None:
    context = ImportContext(studio.database, studio.app.state.storage, studio.settings)
    with pytest.raises(Exception, match=r"(?i)foreign key"):
        import_recording(context, make_recording(), {}, uuid.uuid4())
    assert left_behind(studio) == []
    with pytest.raises(ImportRefusedError):
        import_recording(context, studio.settings.data_dir / "nothing", {}, LOCAL_ACCOUNT_ID)
    assert left_behind(studio) == []
    assert studio.client.get("/api/v1/sequences").json()["items"] == []


def test_a_recording_damaged_behind_its_header_is_refused_at_confirmation(studio: Studio, make_recording) -> None:
    folder = make_recording(frames=30)
    path = folder / "depth" / "000017.png"
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 0xFF
    path.write_bytes(bytes(data))
    found = upload(studio.client, parts_of(folder)).json()
    if found["state"] == "checked":
        answer = studio.client.post(f"/api/v1/imports/{found['id']}/confirm", json={})
        assert answer.status_code == 422
        assert "000017" in answer.json()["detail"]
        assert str(studio.settings.data_dir) not in answer.text
    assert [path.name for path in left_behind(studio)] == [found["id"]]
    assert studio.client.get("/api/v1/sequences").json()["items"] == []
    with studio.database.reading() as session:
        assert session.scalars(select(ImportRow.state)).one() in ("checked", "refused")


def test_the_form_lists_every_option_with_its_help(client: TestClient) -> None:
    form = client.get("/api/v1/imports/form").json()
    assert "recording_folder" in form["formats"]
    types = {item["name"]: item["type"] for item in form["options"]}
    assert (types["fx"], types["hands"], types["name"], types["allow_gaps"]) == (
        "number",
        "string[]",
        "string",
        "boolean",
    )
    assert all(item["help"] for item in form["options"])


def test_a_name_is_proposed_from_what_was_dropped() -> None:
    assert propose_name(["take/a.png", "take/b.png"]) == "take"
    assert propose_name(["a.png", "b.png"]) == "recording"
    assert propose_name(["walk.zip"]) == "walk"
    assert propose_name(["take/a.png"]) == "take"


def test_everything_is_asked_in_one_round_with_pictures_of_what_would_come_in(
    client: TestClient, make_recording
) -> None:
    folder = make_recording("bare")
    (folder / "sequence.json").unlink()
    (folder / "raw").mkdir()
    for path in sorted((folder / "depth").iterdir()):
        (folder / "raw" / path.name).write_bytes(path.read_bytes())
    found = upload(client, parts_of(folder)).json()
    url = f"/api/v1/imports/{found['id']}"
    needed = {q["field"]: q for q in found["report"]["questions"] if q["is_required"]}
    assert list(needed) == ["depth_pattern", "fx", "cx", "cy", "depth_scale"]
    for choice in needed["depth_pattern"]["choices"]:
        picture = client.get(f"{url}/picture", params={"name": choice["pictures"][0]})
        assert (picture.status_code, picture.headers["content-type"]) == (200, "image/jpeg")
        assert picture.content.startswith(b"\xff\xd8")
    for name in ("../../studio.db", "/etc/passwd", "depth", "nothing.png"):
        assert client.get(f"{url}/picture", params={"name": name}).status_code == 404
    told = {"depth_pattern": "raw/*.png", "fx": 32, "cx": 16, "cy": 12, "depth_scale": 0.001}
    again = client.post(f"{url}/check", json={"options": told}).json()
    assert again["state"] == "checked", again["report"]["problems"]
    stored = client.post(f"{url}/confirm", json={"name": "raw", "options": told})
    assert stored.status_code == 201


def test_what_somebody_else_told_meanwhile_is_not_stored_unseen(client: TestClient, make_recording) -> None:
    found = upload(client, parts_of(make_recording()), hands=["right"]).json()
    url = f"/api/v1/imports/{found['id']}"
    client.post(f"{url}/check", json={"options": {"hands": ["left"]}})
    answer = client.post(f"{url}/confirm", json={"options": {"hands": ["right"]}})
    assert (answer.status_code, client.get("/api/v1/sequences").json()["items"]) == (409, [])
    assert client.post(f"{url}/confirm", json={"options": {"hands": ["left"]}}).status_code == 201


def test_the_form_lists_typical_sensors_with_their_source(client: TestClient) -> None:
    presets = {item["name"]: item for item in client.get("/api/v1/imports/form").json()["presets"]}
    for name in ("kinect_v1", "kinect_v2", "azure_kinect_narrow", "realsense_d405", "orbbec_astra", "primesense"):
        assert presets[name]["source"] and presets[name]["modes"], name
