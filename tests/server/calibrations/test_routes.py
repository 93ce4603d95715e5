"""Films of a board: sent, checked, refused with all that is wrong at once, and never half kept."""

from __future__ import annotations

import io
import os
import uuid
import zipfile
from datetime import timedelta
from typing import Any

import cv2
import numpy as np
import pytest
from sqlalchemy import select, update

from server.access.models import AuditRow
from server.calibrations.models import CalibrationRow
from server.calibrations.service import remove_abandoned
from server.database import utc_now
from server.jobs.calibrate_workflow import STAGES
from tests.server.calibrations.films import BOARD, make_form, render_films
from tests.server.conftest import Studio

API = "/api/v1"


def send(studio: Studio, files: dict[str, bytes], **options: Any) -> Any:
    return studio.client.post(f"{API}/calibrations", **make_form(files, **options))


def pack(files: dict[str, bytes]) -> bytes:
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w") as archive:
        for name, data in files.items():
            archive.writestr(name, data)
    return out.getvalue()


def image(value: int = 0) -> bytes:
    return cv2.imencode(".png", np.full((24, 32), value, np.uint8))[1].tobytes()


def kept(studio: Studio) -> list[str]:
    """What lies where films, results and uploads are kept."""
    data = studio.settings.data_dir
    areas = ("films", "film_uploads", "calibrations")
    return [entry.name for area in areas for entry in (data / area).glob("*") if (data / area).is_dir()]


def test_films_are_sent_checked_listed_and_deleted_and_come_back(studio: Studio) -> None:
    answer = send(studio, render_films())
    assert answer.status_code == 201, answer.text
    made = answer.json()
    assert (made["name"], made["state"], made["result"], made["job_id"]) == ("Rig", "checked", None, None)
    assert made["report"]["board"].startswith("ChArUco 5x4, squares of 60 mm")
    seen = made["report"]["cameras"]
    assert [(one["name"], one["kind"], one["frames"], one["fps"]) for one in seen] == [
        ("cam0", "video", 60, 10.0),
        ("cam1", "video", 60, 10.0),
    ]
    assert (seen[0]["width"], seen[0]["height"]) == (480, 360)
    assert made["report"]["problems"] == made["report"]["notes"] == []
    assert studio.client.get(f"{API}/calibrations").json()["items"] == [made]
    place = f"{API}/calibrations/{made['id']}"
    assert studio.client.get(place).json() == made
    assert studio.client.get(f"{place}/files/cameras.toml").status_code == 404
    assert studio.client.get(f"{place}/coverage/0.png").status_code == 404
    assert studio.client.delete(place).status_code == 204
    assert studio.client.get(place).status_code == 404
    [binned] = studio.client.get(f"{API}/bin").json()["items"]
    assert (binned["kind"], binned["word"], binned["name"]) == ("calibration", "camera calibration", "Rig")
    assert studio.client.post(f"{API}/bin/calibration/{made['id']}/restore").status_code == 204
    assert studio.client.get(place).json() == made
    with studio.database.reading() as session:
        acts = session.scalars(select(AuditRow.act).where(AuditRow.subject_id == uuid.UUID(made["id"]))).all()
    assert set(acts) == {"calibration.upload", "calibration.delete", "calibration.restore"}


def test_all_that_is_wrong_is_said_at_once_and_mended_without_sending_again(studio: Studio) -> None:
    good = render_films()
    short = {f"short/{number}.png": image(number) for number in range(9)}
    files = {**good, **short, "broken.mp4": b"no video at all", "empty/readme.txt": b"-", "lenses/c.toml": b"["}
    bad_board = {**BOARD, "marker_mm": 60.0}
    made = send(studio, files, board=bad_board, fps=10.0).json()
    assert made["state"] == "refused" and made["report"]["board"] == ""
    said = made["report"]["problems"]
    for words in (
        "empty: holds neither images",
        "Board 5x4: a marker measures 60 mm",
        "The known lenses: c.toml",
        "broken.mp4: is no MP4, MOV, AVI, MKV or WebM video",
        "short: stops in the middle: its video has 9 frames (0.9 s), that of cam0 lasts 6.0 s",
    ):
        assert any(words in problem for problem in said), (words, said)
    assert str(studio.settings.data_dir) not in str(made)
    body = {"calibration_id": made["id"]}
    check = studio.client.post(f"{API}/jobs/calibrate/check", json=body).json()
    assert (check["can_start"], check["obstacles"]) == (False, said)
    refused = studio.client.post(f"{API}/jobs/calibrate", json=body)
    assert refused.status_code == 422 and refused.json()["obstacles"] == said
    options = {"board": BOARD, "fps": None}
    again = studio.client.post(f"{API}/calibrations/{made['id']}/check", json={"options": options}).json()
    assert again["id"] == made["id"] and again["options"]["board"] == {**BOARD, "inverted": False, "legacy": False}
    assert not any("Board" in problem for problem in again["report"]["problems"])
    assert any("short: images without a frame rate" in note for note in again["report"]["notes"])


@pytest.mark.parametrize("count", [1, 17])
def test_too_few_and_too_many_cameras_are_counted(studio: Studio, count: int) -> None:
    files = {f"cam{number:02d}/{frame}.png": image() for number in range(count) for frame in range(2)}
    made = send(studio, pack_all(files)).json()
    assert made["state"] == "refused"
    assert any(f"{count} camera" in said and "needed 2 to 16" in said for said in made["report"]["problems"])


def pack_all(files: dict[str, bytes]) -> dict[str, bytes]:
    return {"all.zip": pack({f"set/{name}": data for name, data in files.items()} | {"set/notes.txt": b"x"})}


def test_archives_folders_and_one_archive_of_all_are_cameras(studio: Studio) -> None:
    images = {f"{frame}.png": image(frame) for frame in range(4)}
    mixed = {"left.zip": pack({f"in/{name}": data for name, data in images.items()})}
    mixed |= {f"right/{name}": data for name, data in images.items()} | {"notes.txt": b"x"}
    report = send(studio, mixed).json()["report"]
    assert [(one["name"], one["kind"], one["frames"]) for one in report["cameras"]] == [
        ("left", "images", 4),
        ("right", "images", 4),
    ]
    assert report["problems"] == [] and any("notes.txt" in note for note in report["notes"])
    whole = pack_all({f"{camera}/{name}": data for camera in ("a", "b") for name, data in images.items()})
    assert [one["name"] for one in send(studio, whole).json()["report"]["cameras"]] == ["a", "b"]
    twice = send(studio, {**mixed, "left.avi": b"x"}).json()["report"]["problems"]
    assert any("left: two cameras have this name" in said for said in twice)


def test_hostile_uploads_are_refused_and_nothing_of_them_is_kept(studio: Studio) -> None:
    escape = io.BytesIO()
    with zipfile.ZipFile(escape, "w") as archive:
        archive.writestr("../../out.avi", b"x")
    bomb = io.BytesIO()
    with zipfile.ZipFile(bomb, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("cam0.avi", b"\0" * 64_000_000)
    for files in (
        {"all.zip": escape.getvalue()},
        {"cam0.zip": bomb.getvalue(), "cam1.avi": b"x"},
        {"../cam0.avi": b"x"},
        {"cam0.zip": b"no archive", "cam1.avi": b"x"},
        {"cam0.zip": pack({"0.png": image()}), "cam0/1.png": image()},
        {},
    ):
        answer = send(studio, files)
        assert answer.status_code == 422, (list(files), answer.text)
    for data in ({"options": "["}, {"options": '{"board": {"kind": "wood"}}'}, {"options": '{"left_out": 0.9}'}):
        answer = studio.client.post(f"{API}/calibrations", files={"files": ("a.avi", b"x")}, data=data)
        assert answer.status_code == 422, answer.text
    assert kept(studio) == []
    assert studio.client.get(f"{API}/calibrations").json()["items"] == []


def test_films_that_nobody_needs_are_removed_and_what_is_used_stays(studio: Studio) -> None:
    images = {f"{camera}/{frame}.png": image(frame) for camera in "ab" for frame in range(2)}
    old, new = (send(studio, images).json() for _ in range(2))
    long_ago = utc_now() - timedelta(hours=50)
    with studio.database.writing() as session:
        films_id = session.get_one(CalibrationRow, uuid.UUID(old["id"])).films_id
        query = update(CalibrationRow).where(CalibrationRow.id == uuid.UUID(old["id"]))
        session.execute(query.values(updated_at=long_ago))
    folder = studio.settings.data_dir / "films" / str(films_id)
    storage = studio.app.state.storage
    assert remove_abandoned(studio.database, storage, 24.0) == 0 and folder.is_dir(), "it has just arrived"
    os.utime(folder, (long_ago.timestamp(), long_ago.timestamp()))
    assert remove_abandoned(studio.database, storage, 24.0) == 1 and not folder.exists()
    assert studio.client.get(f"{API}/calibrations/{old['id']}").status_code == 404
    assert studio.client.get(f"{API}/calibrations").json()["items"] == [new]


def test_boards_are_printed_and_shown_and_impossible_ones_are_refused(studio: Studio) -> None:
    form = studio.client.get(f"{API}/calibrations/form").json()
    assert [choice["board"]["kind"] for choice in form["boards"]] == ["charuco", "apriltag", "checkerboard"]
    assert form["most_cameras"] == 16 and "DICT_5X5_100" in form["dictionaries"]
    for choice in form["boards"]:
        pdf = studio.client.get(f"{API}/calibrations/board.pdf", params=choice["board"])
        assert pdf.status_code == 200 and pdf.content.startswith(b"%PDF"), pdf.text
        assert ".pdf" in pdf.headers["content-disposition"]
        answer = studio.client.get(f"{API}/calibrations/board.png", params=choice["board"])
        picture = cv2.imdecode(np.frombuffer(answer.content, np.uint8), cv2.IMREAD_GRAYSCALE)
        assert picture is not None and max(picture.shape) > 600
        assert 0.2 < (picture < 128).mean() < 0.8
    bad = studio.client.get(f"{API}/calibrations/board.pdf", params={"kind": "checkerboard", "columns": 6, "rows": 8})
    assert bad.status_code == 422 and "looks the same" in bad.json()["detail"]
    assert studio.client.get(f"{API}/calibrations/board.png", params={"columns": 4000}).status_code == 422


def test_the_stages_of_the_bar_are_those_that_the_tracker_names() -> None:
    assert len(set(STAGES)) == len(STAGES) == 5
