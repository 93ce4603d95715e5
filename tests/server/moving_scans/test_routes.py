"""`/moving-scans`: frames in the order of their names, files that cannot be used, and what the browser plays."""

from __future__ import annotations

import numpy as np
import pytest

from server.moving_scans.adding import order_naturally
from server.scans.geometry import choose_points
from server.storage.digest import compute_digest
from tests.server.conftest import Studio
from tests.server.moving_scans.moving import API, MovingPerson, add, moving_person, pack, send
from tests.server.packed_arrays import unpack_arrays
from tests.server.teams.conftest import Join, join
from tracker import read_scan

__all__ = ["join", "moving_person"]

EMPTY = b"ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\nend_header\n"


def test_a_zip_becomes_one_thing_whose_frames_are_in_the_order_of_time_and_a_broken_one_keeps_its_place(
    studio: Studio, moving_person: MovingPerson
) -> None:
    one, two, three = moving_person.files.values()
    frames = {"f10.ply": three, "f1.ply": one, "f2.ply": b"", "f9.ply": two, "f11.ply": two[:4000], "notes.txt": b"x"}
    scan = add(studio, {"ada.zip": pack(frames)}, subject="Ada", fps=30)
    assert (scan["name"], scan["subject"], scan["fps"]) == ("walking", "Ada", 30.0)
    assert (scan["frame_count"], scan["usable_count"]) == (5, 3)
    assert [(each["frame"], each["name"]) for each in scan["problems"]] == [
        (1, "walking/f2.ply"),
        (4, "walking/f11.ply"),
    ]
    assert all(each["detail"] and "/frames" not in each["detail"] for each in scan["problems"])
    assert str(studio.settings.data_dir) not in str(scan)
    assert (scan["metres_per_unit"], scan["is_unit_guessed"]) == (1.0, True)
    assert any("1 other file" in note for note in scan["notes"])
    for frame, number in ((0, 0), (2, 1), (3, 2)):
        answer = studio.client.get(f"{API}/moving-scans/{scan['id']}/frames/{frame}/geometry")
        assert answer.status_code == 200 and "immutable" in answer.headers["cache-control"]
        arrays, told = unpack_arrays(answer.content)
        points = np.array(told["origin_m"]) + np.array(told["step_m"]) * arrays["positions"]
        path = moving_person.folder / f"frame{number}.ply"
        true, digest = read_scan(path).points, compute_digest(path)
        np.testing.assert_allclose(points, true[choose_points(len(true), 20_000, digest)], atol=5e-5)
    gone = studio.client.get(f"{API}/moving-scans/{scan['id']}/frames/1/geometry")
    assert gone.status_code == 404 and "cannot be shown" in gone.json()["detail"]
    assert studio.client.get(f"{API}/moving-scans/{scan['id']}/frames/5/geometry").status_code == 404
    file = studio.client.get(f"{API}/moving-scans/{scan['id']}/frames/2/file")
    assert file.content == two and "000002" in file.headers["content-disposition"]
    assert studio.client.get(f"{API}/moving-scans/{scan['id']}/thumbnail.png").content[:4] == b"\x89PNG"
    points = np.concatenate([body.scan.points for body in moving_person.bodies])
    np.testing.assert_allclose(scan["box_m"], [points.min(axis=0), points.max(axis=0)], atol=1e-6)
    assert not any((studio.settings.data_dir / "scan_uploads").iterdir())


def test_the_same_frames_sent_again_are_kept_once_and_in_another_order_they_are_another(
    studio: Studio, moving_person: MovingPerson
) -> None:
    one, two, _ = moving_person.files.values()
    first = add(studio, {"a.ply": one, "b.ply": two}, name="first")
    again = send(studio, {"x/c.ply": one, "x/d.ply": two}, name="again")
    assert again.status_code == 200 and again.json()["is_known"]
    assert again.json()["moving_scan"]["id"] == first["id"]
    other = add(studio, {"a.ply": two, "b.ply": one})
    assert other["id"] != first["id"] and other["name"] == "Moving scan"
    assert len(list((studio.settings.data_dir / "moving_scans").iterdir())) == 2
    listed = studio.client.get(f"{API}/moving-scans", params={"search": "FIRST"}).json()["items"]
    assert [each["id"] for each in listed] == [first["id"]]


def test_the_unit_is_told_by_the_first_frame_that_can_be_read_and_holds_for_all(
    studio: Studio, moving_person: MovingPerson, tmp_path
) -> None:
    from tracker.capture.scan import save_scan

    for t, body in enumerate(moving_person.bodies[:2]):
        save_scan(body.scan.scaled(1000.0 if t == 0 else 1.0), tmp_path / f"{t}.ply")
    files = {path.name: path.read_bytes() for path in sorted(tmp_path.glob("?.ply"))}
    mixed = add(studio, {"00.ply": b"", **files})
    assert mixed["metres_per_unit"] == pytest.approx(0.001) and mixed["usable_count"] == 1
    assert "correct its unit" in mixed["problems"][1]["detail"]
    refused = send(studio, {"0.ply": files["0.ply"]}, metres_per_unit=1.0)
    assert refused.status_code == 422 and "1 unit = 1000 mm" in refused.json()["detail"]


@pytest.mark.parametrize(
    ("files", "options", "status", "told"),
    [
        ({"a.ply": EMPTY, "b.ply": b"junk"}, {}, 422, "None of the scans can be used. a.ply"),
        ({"a.npz": b"junk"}, {}, 422, "There are no scans in it"),
        ({"../a.ply": EMPTY}, {}, 422, "The file name '../a.ply'"),
        ({"a.zip": b"PK\x03\x04 cut"}, {}, 422, "a.zip"),
        ({"a.ply": EMPTY}, {"fps": 0}, 422, "fps"),
        ({"a.ply": EMPTY}, {"fps": True}, 422, "fps"),
        ({"a.ply": EMPTY}, {"metres_per_unit": -1}, 422, "metres_per_unit"),
        ({"a.ply": EMPTY}, {"speed": 3}, 422, "speed"),
    ],
)
def test_what_is_no_moving_scan_is_refused_in_a_sentence_and_leaves_nothing(
    studio: Studio, files: dict[str, bytes], options: dict, status: int, told: str
) -> None:
    answer = send(studio, files, **options)
    assert answer.status_code == status and told in answer.json()["detail"], answer.text
    assert str(studio.settings.data_dir) not in answer.text
    assert studio.client.get(f"{API}/moving-scans").json()["items"] == []
    area = studio.settings.data_dir / "moving_scans"
    assert not area.exists() or not any(area.iterdir())


def test_a_zip_that_climbs_out_of_its_folder_is_refused(studio: Studio, moving_person: MovingPerson) -> None:
    answer = send(studio, {"a.zip": pack({"../../evil.ply": moving_person.files["frame0.ply"]})})
    assert answer.status_code == 422, answer.text
    assert not list(studio.settings.data_dir.rglob("evil.ply"))


def test_leads_add_change_and_delete_and_the_bin_brings_back(
    studio: Studio, moving_person: MovingPerson, join: Join
) -> None:
    scan = add(studio, {"a.ply": moving_person.files["frame0.ply"]})
    ann, lea = join("ann", "reviewer"), join("lea", "lead")
    where = f"/moving-scans/{scan['id']}"
    for method, path, body in (
        ("POST", "/moving-scans", None),
        ("PATCH", where, {"name": "x"}),
        ("DELETE", where, None),
    ):
        assert ann.send(method, path, body).status_code == 403
    changed = lea.send("PATCH", where, {"name": "Ada waves", "fps": 120.0}).json()
    assert (changed["name"], changed["fps"], changed["subject"]) == ("Ada waves", 120.0, "")
    assert lea.send("DELETE", where).status_code == 204
    assert ann.send("GET", where).status_code == 404 and ann.get("/moving-scans")["items"] == []
    assert lea.send("POST", f"/bin/moving_scan/{scan['id']}/restore").status_code == 204
    assert ann.get(where)["name"] == "Ada waves"
    lea.send("DELETE", where)
    assert lea.send("DELETE", f"/bin/moving_scan/{scan['id']}").status_code == 204
    assert not any((studio.settings.data_dir / "moving_scans").iterdir())


def test_numbers_in_names_count_as_numbers() -> None:
    names = ["f10.ply", "f9.ply", "F1.ply", "g/2.ply", "g/10.ply", "f²0.ply"]
    assert sorted(names, key=order_naturally) == ["F1.ply", "f9.ply", "f10.ply", "f²0.ply", "g/2.ply", "g/10.ply"]
