"""Every download is called after what it is of."""

from __future__ import annotations

import json
from urllib.parse import unquote

import pytest

from server.download import make_file_name, name_download
from tests.server.conftest import Studio

HOSTILE = 'Hände/手 "1"\r\nX-Evil: yes; %41\u202e'


@pytest.mark.parametrize(
    ("parts", "name"),
    [
        (["Take 7", "labels"], "Take_7-labels.json"),
        (["../../etc/passwd", "x"], "etc_passwd-x.json"),
        ([""], "handloom.json"),
        (["CON"], "handloom-CON.json"),
        (["a" * 500, "b"], "a" * 120 + ".json"),
        (["手", "labels"], "手-labels.json"),
    ],
)
def test_names_are_safe_on_every_system(parts: list[str], name: str) -> None:
    assert make_file_name(parts, ".json") == name


def test_old_programs_get_ascii_and_new_ones_the_name_itself() -> None:
    header = name_download(HOSTILE, suffix=".csv")["Content-Disposition"]
    assert header.isascii() and header.isprintable()
    plain, _, full = header.partition("; filename*=UTF-8''")
    assert plain.startswith('attachment; filename="Hande') and plain.endswith('.csv"') and plain.count('"') == 2
    assert unquote(full).startswith("Hände_手_1_X-Evil") and unquote(full).endswith(".csv")
    assert name_download("手", suffix=".csv")["Content-Disposition"].startswith('attachment; filename="download.csv"')
    assert name_download("Take 7", suffix=".csv")["Content-Disposition"] == 'attachment; filename="Take_7.csv"'


def test_labels_and_snapshots_carry_the_name_of_their_recording(studio: Studio, make_recording) -> None:
    client = studio.client
    parts = [
        ("files", (path.relative_to(folder).as_posix(), path.read_bytes()))
        for folder in [make_recording("waving")]
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    ]
    made = client.post("/api/v1/imports", files=parts, data={"options": json.dumps({"name": "Anna's 2nd take"})}).json()
    recording = client.post(f"/api/v1/imports/{made['id']}/confirm", json={}).json()
    base = f"/api/v1/sequences/{recording['id']}"
    client.put(
        f"{base}/annotations/cam0/0/right",
        json={"points": [[4, 4, 2]] * 21, "operation_id": "6a1c1f0e-3a3b-4f0a-9d55-6f1f3b6f0a11"},
        headers={"If-None-Match": "*"},
    ).raise_for_status()
    snapshot = client.post(f"{base}/labels/snapshots", json={"name": "first"}).json()
    addresses = {
        f"{base}/annotations.json": "Anna's_2nd_take-annotations.json",
        f"{base}/labels/export?format=coco_keypoints": "Anna's_2nd_take-coco_keypoints.json",
        f"{base}/labels/export?format=deeplabcut": "Anna's_2nd_take-deeplabcut.zip",
        f"/api/v1/snapshots/{snapshot['id']}/labels.json": "Anna's_2nd_take-labels-v1-",
    }
    for address, name in addresses.items():
        answer = client.get(address)
        assert answer.status_code == 200, answer.text
        assert f'filename="{name}' in answer.headers["Content-Disposition"], address
    notes = client.get(f"{base}/labels/export/notes?format=deeplabcut").json()
    assert notes["file"] == "Anna's_2nd_take-deeplabcut.zip", "the page says the name that the file will have"


def test_a_refused_format_gives_one_sentence_with_the_rest_aside(studio: Studio, make_recording) -> None:
    folder = make_recording("waving")
    parts = [
        ("files", (path.relative_to(folder).as_posix(), path.read_bytes()))
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    ]
    made = studio.client.post("/api/v1/imports", files=parts).json()
    recording = studio.client.post(f"/api/v1/imports/{made['id']}/confirm", json={}).json()
    base = f"/api/v1/sequences/{recording['id']}/labels"
    labels = [("files", (name, b"[]")) for name in ("training_K.json", "training_xyz.json")]
    refused = studio.client.post(f"{base}/check", files=labels)
    assert refused.status_code == 422, refused.text
    body = refused.json()
    assert body["detail"].count(". ") == 0 and "add the file handloom_samples.json" in body["detail"]
    assert len(body["details"]) == 2


def test_every_attachment_is_named_by_the_one_helper() -> None:
    from pathlib import Path

    server = Path(__file__).parents[2] / "server"
    own = [
        path.relative_to(server).as_posix()
        for path in server.rglob("*.py")
        if "attachment" in path.read_text() or "filename=f" in path.read_text()
    ]
    assert own == ["download.py"]
