"""`/bin`: what was deleted is listed with who did it, and comes back."""

from __future__ import annotations

import uuid
from pathlib import Path

from sqlalchemy import select, update

from server.access.models import LOCAL_ACCOUNT_ID, AuditRow
from server.database import Base
from server.jobs.models import JobRow
from tests.server.conftest import GeneratedHand, Studio, Tracked
from tests.server.curation import API, add_curation, make_ball, send_scans
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
    assert again.status_code == 404 and "restored it" in again.json()["detail"]
    assert lea.send("POST", f"/bin/project/{project['id']}/restore").status_code == 204
    assert lea.get("/bin", kind="project")["items"] == []
    assert lea.send("POST", f"/bin/moon/{first['id']}/restore").status_code == 404


def test_only_leads_look_into_the_bin(join: Join) -> None:
    ann = join("ann")
    assert ann.send("GET", "/bin").status_code == 403
    assert ann.send("GET", f"/bin/scan/{uuid.uuid4()}/erasure").status_code == 403
    assert ann.send("DELETE", f"/bin/scan/{uuid.uuid4()}").status_code == 403


def test_a_track_comes_back_after_its_recording_only(studio: Studio, tracked: Tracked) -> None:
    sequence = studio.client.get(f"{API}/tracks/{tracked.track_id}").json()["sequence_id"]
    assert studio.client.delete(f"{API}/tracks/{tracked.track_id}").is_success
    assert studio.client.delete(f"{API}/sequences/{sequence}").is_success
    early = studio.client.post(f"{API}/bin/track/{tracked.track_id}/restore")
    assert early.status_code == 409 and "is in the bin too" in early.json()["detail"], early.text
    assert studio.client.post(f"{API}/bin/recording/{sequence}/restore").status_code == 204
    assert studio.client.post(f"{API}/bin/track/{tracked.track_id}/restore").status_code == 204
    assert studio.client.get(f"{API}/tracks/{tracked.track_id}").is_success


def count_rows(studio: Studio) -> dict[str, int]:
    with studio.database.reading() as session:
        return {
            name: len(session.execute(select(table)).all())
            for name, table in Base.metadata.tables.items()
            if name not in ("audit", "accounts", "logins", "tokens", "workers")
        }


def list_files(studio: Studio) -> list[str]:
    root = studio.settings.data_dir
    areas = ("sequences", "tracks", "snapshots", "uploads", "jobs", "scans", "registrations", "models")
    return sorted(str(path.relative_to(root)) for area in areas for path in (root / area).rglob("*") if path.is_file())


def test_a_recording_deleted_for_good_takes_what_hangs_on_it_and_nothing_else(
    studio: Studio, tracked: Tracked, add_recording, join: Join
) -> None:
    lea = join("lea", "lead")
    project = lea.make("/projects", name="Hands")
    before, files = count_rows(studio), list_files(studio)
    other = add_recording()
    kept, kept_files = count_rows(studio), list_files(studio)
    gone = str(tracked.sequence_id)
    lea.send("PUT", f"/projects/{project['id']}/sequences/{gone}")
    work = {"sequence_id": gone, "account_id": lea.id, "frame_first": 0, "frame_last": 3}
    given = lea.make(f"/projects/{project['id']}/assignments", **work)
    lea.make(f"/assignments/{given['id']}/comments", text="Look.")
    lea.make(f"/sequences/{gone}/labels/snapshots", name="before")
    job = lea.make("/jobs", sequence_id=gone)
    assert studio.client.delete(f"{API}/sequences/{gone}").is_success

    address = f"/bin/recording/{gone}"
    told = lea.get(f"{address}/erasure")
    assert "cancel" in told["obstacle"]
    assert lea.send("DELETE", address).status_code == 409
    assert lea.send("POST", f"/jobs/{job['id']}/cancel").is_success
    told = lea.get(f"{address}/erasure")
    counts = {one["word"]: one["count"] for one in told["going"]}
    assert told["obstacle"] is None and told["byte_count"] > 100_000
    assert counts | {"label": 45, "track": 1, "assignment": 1, "comment": 1, "job": 1, "label snapshot": 1} == counts
    assert lea.send("DELETE", address).status_code == 204

    now = count_rows(studio)
    extra = {name: count for name in now if (count := kept[name] - before[name])}
    # What is left is the other recording with its own, the project and who was there.
    assert {name: count for name, count in now.items() if count} == extra | {
        name: before[name] for name in ("projects",) if before[name]
    }
    assert list_files(studio) == [file for file in kept_files if file not in files]
    assert studio.client.get(f"{API}/sequences/{other['id']}").json() == other
    assert lea.send("POST", f"{address}/restore").status_code == 404
    assert lea.send("DELETE", address).status_code == 404
    with studio.database.reading() as session:
        [line] = session.scalars(select(AuditRow).where(AuditRow.act == "recording.erase"))
    assert line.detail["label"] == 45 and line.detail["track"] == 1


def test_what_a_model_was_made_from_stays(studio: Studio, generated_hand: GeneratedHand) -> None:
    ids = add_curation(studio.app, generated_hand, LOCAL_ACCOUNT_ID)
    before, files = count_rows(studio), list_files(studio)
    for kind, address, id_, why in (
        ("scan", "scans", ids["scan_id"], "a training set was made from a registration of it"),
        ("hand_model", "hand-models", ids["model_id"], "registrations were made with it"),
    ):
        studio.client.delete(f"{API}/{address}/{id_}")
        assert studio.client.get(f"{API}/bin/{kind}/{id_}/erasure").json()["obstacle"] == why
        refused = studio.client.delete(f"{API}/bin/{kind}/{id_}")
        assert refused.status_code == 409 and why in refused.json()["detail"]
    assert count_rows(studio) == before and list_files(studio) == files


def test_a_track_goes_and_its_job_stays_without_it(studio: Studio, tracked: Tracked) -> None:
    job = studio.client.post(f"{API}/jobs", json={"sequence_id": str(tracked.sequence_id)}).json()["id"]
    assert studio.client.post(f"{API}/jobs/{job}/cancel").is_success
    with studio.database.writing() as session:
        session.execute(update(JobRow).values(track_id=tracked.track_id))
    assert studio.client.delete(f"{API}/tracks/{tracked.track_id}").is_success
    told = studio.client.get(f"{API}/bin/track/{tracked.track_id}/erasure").json()
    assert told["name"] and told["going"] == [] and told["obstacle"] is None
    assert studio.client.delete(f"{API}/bin/track/{tracked.track_id}").status_code == 204
    assert not (studio.settings.data_dir / "tracks" / str(tracked.track_id)).exists()
    assert studio.client.get(f"{API}/jobs/{job}").json()["track_id"] is None
    assert studio.client.get(f"{API}/sequences/{tracked.sequence_id}").is_success
    assert studio.client.get(f"{API}/bin").json()["items"] == []


def test_a_project_stays_in_the_bin(join: Join) -> None:
    lea = join("lea", "lead")
    project = lea.make("/projects", name="Hands")
    assert lea.send("DELETE", f"/projects/{project['id']}").status_code == 204
    refused = lea.send("DELETE", f"/bin/project/{project['id']}")
    assert refused.status_code == 409 and "stays in the bin" in refused.json()["detail"]
