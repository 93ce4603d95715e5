"""`/bin`: what was deleted is listed with who did it, and comes back."""

from __future__ import annotations

from pathlib import Path

from tests.server.conftest import Studio, Tracked
from tests.server.curation import API, make_ball, send_scans
from tests.server.scans.test_routes import write
from tests.server.teams.conftest import Join, join

__all__ = ["join"]


def test_what_was_deleted_is_listed_the_last_first_and_comes_back(studio: Studio, tmp_path: Path, join: Join) -> None:
    lea = join("lea", "lead")
    scans = [send_scans(studio, {f"{n}.ply": write(tmp_path, make_ball(n))}).json()["added"][0] for n in range(3)]
    project = lea.send("POST", "/projects", {"name": "Gone project"}).json()
    for scan in scans:
        assert lea.send("DELETE", f"/scans/{scan['id']}").status_code == 204
    assert lea.send("DELETE", f"/projects/{project['id']}").status_code == 204
    names, cursor = [], None
    while True:
        page = lea.get("/bin", limit=3, **({"cursor": cursor} if cursor else {}))
        names += [(item["kind"], item["name"]) for item in page["items"]]
        cursor = page["next_cursor"]
        if cursor is None:
            break
    assert names == [("project", "Gone project"), ("scan", "2"), ("scan", "1"), ("scan", "0")]
    [first, *_] = lea.get("/bin", kind="scan")["items"]
    assert first["deleted_by_name"] == "lea" and first["byte_count"] == scans[2]["byte_count"]
    assert lea.send("POST", f"/bin/scan/{first['id']}/restore").status_code == 204
    assert studio.client.get(f"{API}/scans/{first['id']}").json() == scans[2]
    again = lea.send("POST", f"/bin/scan/{first['id']}/restore")
    assert again.status_code == 404 and "brought it back" in again.json()["detail"]
    assert lea.send("POST", f"/bin/project/{project['id']}/restore").status_code == 204
    assert lea.get("/bin", kind="project")["items"] == []
    assert lea.send("POST", f"/bin/moon/{first['id']}/restore").status_code == 404


def test_only_leads_look_into_the_bin(join: Join) -> None:
    ann = join("ann")
    assert ann.send("GET", "/bin").status_code == 403


def test_a_track_comes_back_after_its_recording_only(studio: Studio, tracked: Tracked) -> None:
    sequence = studio.client.get(f"{API}/tracks/{tracked.track_id}").json()["sequence_id"]
    assert studio.client.delete(f"{API}/tracks/{tracked.track_id}").is_success
    assert studio.client.delete(f"{API}/sequences/{sequence}").is_success
    early = studio.client.post(f"{API}/bin/track/{tracked.track_id}/restore")
    assert early.status_code == 409 and "is in the bin too" in early.json()["detail"], early.text
    assert studio.client.post(f"{API}/bin/recording/{sequence}/restore").status_code == 204
    assert studio.client.post(f"{API}/bin/track/{tracked.track_id}/restore").status_code == 204
    assert studio.client.get(f"{API}/tracks/{tracked.track_id}").is_success
