"""The unit of a scan's file: shown before anything is stored, never guessed where it is open, and corrected later."""

from __future__ import annotations

import json
import re
import uuid
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from server.scans.models import ScanRow
from tests.server.conftest import Studio
from tests.server.curation import API, Curation, add_registered, curation, make_ball, send_scans
from tests.server.scans.test_routes import crop, fetch, write
from tests.server.teams.conftest import join

__all__ = ["curation", "join"]

REAL_UNIT = 0.0285
"""m; of scans whose unit is none of the usual ones, as real ones are."""


def write_in(tmp_path: Path, metres_per_unit: float, seed: int = 0) -> bytes:
    """A ball of 16 cm in a file with this unit."""
    return write(tmp_path, make_ball(seed, radius=0.08 / metres_per_unit))


def measure(studio: Studio, files: dict[str, bytes]) -> dict[str, Any]:
    parts = [("files", (name, data)) for name, data in files.items()]
    answer = studio.client.post(f"{API}/scans/measure", files=parts)
    assert answer.status_code == 200, answer.text
    return answer.json()


def put_unit(studio: Studio, scan: dict[str, Any], unit: float, revision: int = 1) -> Any:
    headers = {"If-Match": f'"{revision}"'}
    return studio.client.put(f"{API}/scans/{scan['id']}/unit", json={"metres_per_unit": unit}, headers=headers)


def read_points(studio: Studio, scan: dict[str, Any]) -> tuple[np.ndarray, np.ndarray]:
    arrays, facts = fetch(studio, scan)
    return np.array(facts["origin_m"]) + np.array(facts["step_m"]) * arrays["positions"], arrays["flags"]


def test_sizes_are_told_before_anything_is_stored(studio: Studio, tmp_path: Path) -> None:
    files = {
        "mm.ply": write_in(tmp_path, 0.001),
        "open.ply": write_in(tmp_path, REAL_UNIT),
        "listed.ply": write_in(tmp_path, REAL_UNIT, 1),
        "junk.ply": b"no scan",
        "scans.json": json.dumps([{"file": "listed.ply", "metres_per_unit": REAL_UNIT}]).encode(),
    }
    told = measure(studio, files)
    listed, mm, open_ = told["files"]
    assert [one["file"] for one in told["files"]] == ["listed.ply", "mm.ply", "open.ply"]
    assert (mm["guess"], mm["is_certain"], mm["metres_per_unit"]) == (0.001, True, None)
    assert mm["size_units"] == pytest.approx([160.0] * 3, rel=0.02)
    assert not open_["is_certain"] and open_["guess"] == 0.0254, "an inch makes a hand of it, and it is none"
    assert listed["metres_per_unit"] == REAL_UNIT
    assert mm["picture"].startswith("data:image/png;base64,") and mm["picture_units"] > mm["size_units"][0]
    assert [one["file"] for one in told["refused"]] == ["junk.ply"]
    assert told["hand_lengths_m"] == [0.08, 0.6]
    assert studio.client.get(f"{API}/scans").json()["items"] == []
    assert not any((studio.settings.data_dir / "scan_uploads").iterdir())


def test_a_unit_that_the_size_leaves_open_is_asked_for(studio: Studio, tmp_path: Path) -> None:
    files = {
        "mm.ply": write_in(tmp_path, 0.001),
        "open.ply": write_in(tmp_path, REAL_UNIT),
        "cm.ply": write_in(tmp_path, 0.01),
    }
    done = send_scans(studio, files).json()
    [mm] = done["added"]
    assert (mm["metres_per_unit"], mm["is_unit_guessed"]) == (0.001, True), "told by its size, and said to be"
    refused = {one["file"]: one["detail"] for one in done["refused"]}
    assert set(refused) == {"open.ply", "cm.ply"}
    assert "1 unit = 1 inch" in refused["open.ply"] and "metres per unit" in refused["open.ply"]
    units = {"open.ply": REAL_UNIT, "cm.ply": 0.01}
    again = send_scans(studio, files, units=units).json()
    assert {one["name"]: one["metres_per_unit"] for one in again["added"]} == {"open": REAL_UNIT, "cm": 0.01}
    assert not any(one["is_unit_guessed"] for one in again["added"])
    assert all(one["size_m"] == pytest.approx([0.16] * 3, rel=0.02) for one in again["added"])


@pytest.mark.parametrize(("unit", "told"), [(0.01, " cm long"), (1.0, " m long")])
def test_a_size_that_no_hand_has_is_refused_though_its_unit_was_said(
    studio: Studio, tmp_path: Path, unit: float, told: str
) -> None:
    done = send_scans(studio, {"a.ply": write_in(tmp_path, REAL_UNIT)}, metres_per_unit=unit).json()
    [refusal] = done["refused"]
    assert done["added"] == [] and re.search(rf"is 5\.\d+{told}.*8 to 60 cm", refusal["detail"]), refusal


def test_a_file_that_is_there_with_another_unit_is_said(studio: Studio, tmp_path: Path) -> None:
    data = write_in(tmp_path, REAL_UNIT)
    send_scans(studio, {"a.ply": data}, metres_per_unit=0.0254)
    again = send_scans(studio, {"a.ply": data}, metres_per_unit=REAL_UNIT).json()
    assert len(again["known"]) == 1 and "1 unit = 25.4 mm" in again["notes"][0]


def test_the_unit_is_corrected_with_all_that_follows(studio: Studio, tmp_path: Path) -> None:
    """Geometry, thumbnails and crops fit the new size, and the addresses of before still give the old one."""
    data = write_in(tmp_path, REAL_UNIT)
    scan = send_scans(studio, {"a.ply": data}, metres_per_unit=0.0254).json()["added"][0]
    view = [*np.diag([10.0, 10.0, 1.0, 1.0]).ravel()]
    square = {"kind": "polygon", "corners": [[-0.4, -0.4], [0.4, -0.4], [0.4, 0.4], [-0.4, 0.4]], "view": view}
    cropped = crop(studio, scan, {"kind": "plane", "normal": [0, 0, 1], "offset": 0.04}, square).json()
    before, flags = read_points(studio, cropped)
    answer = put_unit(studio, cropped, REAL_UNIT, revision=2)
    assert answer.status_code == 200, answer.text
    changed = answer.json()
    assert (changed["revision"], changed["metres_per_unit"], answer.headers["etag"]) == (3, REAL_UNIT, '"3"')
    assert changed["removed_count"] == cropped["removed_count"] > 0
    assert changed["extent_m"] == pytest.approx([0.16] * 3, rel=0.02)
    assert changed["size_m"][0] == pytest.approx(cropped["size_m"][0] * REAL_UNIT / 0.0254)
    after, flags_after = read_points(studio, changed)
    np.testing.assert_allclose(after, before * REAL_UNIT / 0.0254, atol=1e-5)
    np.testing.assert_array_equal(flags_after, flags)
    np.testing.assert_array_equal(read_points(studio, cropped)[0], before)
    picture = studio.client.get(f"{API}/scans/{scan['id']}/thumbnail/{changed['geometry_key']}.png")
    assert picture.status_code == 200
    history = studio.client.get(f"{API}/scans/{scan['id']}/crop/history").json()["items"]
    assert [(item["revision"], item["metres_per_unit"]) for item in history] == [
        (3, REAL_UNIT),
        (2, 0.0254),
        (1, 0.0254),
    ]
    assert put_unit(studio, scan, 0.03, revision=2).json()["theirs"]["revision"] == 3
    address = f"{API}/scans/{scan['id']}/unit"
    assert studio.client.put(address, json={"metres_per_unit": 0.03}).status_code == 428
    acts = studio.client.get(f"{API}/audit", params={"act": "scan.unit"}).json()["items"]
    assert [(act["detail"]["from"], act["detail"]["to"]) for act in acts] == [(0.0254, REAL_UNIT)]


def test_a_correction_to_no_hand_s_size_is_refused(studio: Studio, tmp_path: Path) -> None:
    scan = send_scans(studio, {"a.ply": write_in(tmp_path, REAL_UNIT)}, metres_per_unit=REAL_UNIT).json()["added"][0]
    answer = put_unit(studio, scan, 0.01)
    assert answer.status_code == 422 and "is 5.57 cm long" in answer.json()["detail"], answer.text
    assert studio.client.get(f"{API}/scans/{scan['id']}").json() == scan


def test_a_scan_of_before_that_never_said_its_unit_keeps_its_size_until_it_is_corrected(
    studio: Studio, tmp_path: Path
) -> None:
    """Earlier versions took 5.6 units for 5.6 cm and stored the extent alone."""
    data = write_in(tmp_path, REAL_UNIT)
    scan = send_scans(studio, {"a.ply": data}, metres_per_unit=REAL_UNIT).json()["added"][0]
    with studio.app.state.database.writing() as session:
        row = session.query(ScanRow).one()
        row.extent_m = [side * 0.01 / REAL_UNIT for side in row.extent_m]
        row.metres_per_unit = row.first_metres_per_unit = row.size_m = None
        row.is_unit_guessed = True
    old = studio.client.get(f"{API}/scans/{scan['id']}").json()
    assert old["size_m"][0] == pytest.approx(0.056, rel=0.02) and old["metres_per_unit"] is None
    small, _ = read_points(studio, old)
    assert np.ptp(small[:, 0]) == pytest.approx(0.056, rel=0.02)
    started = studio.client.post(f"{API}/jobs/register", json={"scan_ids": [scan["id"]]})
    assert started.status_code == 422 and "a is 5.61 cm long" in started.json()["detail"], started.text
    changed = put_unit(studio, old, REAL_UNIT).json()
    assert np.ptp(read_points(studio, changed)[0][:, 0]) == pytest.approx(0.16, rel=0.02)
    np.testing.assert_array_equal(read_points(studio, old)[0], small)
    assert studio.client.post(f"{API}/jobs/register", json={"scan_ids": [scan["id"]]}).status_code < 300


def test_a_scene_is_taken_in_and_registered_only_when_it_is_cropped(studio: Studio, tmp_path: Path) -> None:
    data = write(tmp_path, make_ball(count=20_000, radius=0.4))
    scan = send_scans(studio, {"a.ply": data}, metres_per_unit=1.0).json()["added"][0]
    started = studio.client.post(f"{API}/jobs/register", json={})
    assert started.status_code == 422 and "crop" in started.json()["detail"], started.text
    assert crop(studio, scan, {"kind": "plane", "normal": [0, 0, -1], "offset": -0.35}).json()["size_m"][0] < 0.6
    assert studio.client.post(f"{API}/jobs/register", json={}).status_code < 300


def test_registrations_of_another_size_no_longer_count(curation: Curation, tmp_path: Path) -> None:
    studio = curation.studio
    scan = send_scans(studio, {"a.ply": write(tmp_path, curation.hand.scan)}, metres_per_unit=1.0).json()["added"][0]
    id_ = add_registered(studio.app, curation.hand, "a", scan_id=uuid.UUID(scan["id"]))
    curation.decide(curation.rob, id_)
    assert studio.client.get(f"{API}/scans/{scan['id']}").json()["state"] == "registered"
    assert len(studio.client.post(f"{API}/training-sets/preview", json={}).json()) and curation.queue(
        curation.rob, queue="all"
    ) == ["a"]
    changed = put_unit(studio, scan, 1.1).json()
    assert (changed["state"], changed["registration"]) == ("new", None)
    assert curation.queue(curation.rob, queue="all") == []
    [kept] = curation.rob.get("/registrations", scan_id=scan["id"], queue="all")["items"]
    assert kept["is_outdated"] and not kept["is_current"]
    assert kept["scan"]["geometry_key"] == scan["geometry_key"], "it is drawn with the points it was made from"
    assert curation.lead.send("POST", "/training-sets", {"name": "x", "rule": {}}).status_code == 422
    back = put_unit(studio, scan, 1.0, revision=2).json()
    assert back["state"] == "registered" and back["registration"]["id"] == str(id_)
