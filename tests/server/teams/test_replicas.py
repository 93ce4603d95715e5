"""Blind replicas: nobody sees what the others marked, and the report returns the noise they made."""

from __future__ import annotations

import csv
import io
import json
import uuid
from typing import Any

import numpy as np
import pytest

from server.access.models import LOCAL_ACCOUNT_ID
from server.access.places import Place
from server.annotations.changes import Change, change_annotation


def assignments_of(person: Any, made: dict[str, Any]) -> dict[str, Any]:
    found = [item for item in person.get("/assignments", mine=True)["items"] if item["replica_set_id"] == made["id"]]
    assert len(found) == 1
    return found[0]


def list_frames(person: Any, sequence: str, **params: Any) -> list[int]:
    return [item["frame"] for item in person.get(f"/sequences/{sequence}/annotations", **params)["items"]]


def test_nobody_sees_the_others_joints_or_the_shared_ones_while_marking(project, ann, bob, reviewer, lead) -> None:
    for frame in (2, 3, 9):
        reviewer.mark(project.sequence, frame)
    made = project.replicate([ann, bob], [2, 5, 7])
    mine, theirs = assignments_of(ann, made), assignments_of(bob, made)
    assert ann.mark(project.sequence, 2, 5, replica=mine["id"]).status_code == 200
    assert bob.mark(project.sequence, 2, 6, replica=theirs["id"]).status_code == 200
    place = f"/sequences/{project.sequence}/annotations/cam0/2/right"

    assert list_frames(ann, project.sequence) == [3, 9], "what everybody marked in the set's frames is hidden"
    file = ann.get(f"/sequences/{project.sequence}/annotations.json")
    assert [item["frame"] for item in file["items"]] == [3, 9]
    for path in (place, f"{place}/history"):
        assert ann.send("GET", path).status_code == 403
        assert ann.send("GET", path, params={"replica": theirs["id"]}).status_code == 403
    assert ann.mark(project.sequence, 2).status_code == 403, "a conflict would show the other's version"
    assert list_frames(ann, project.sequence, replica=mine["id"]) == [2]
    assert ann.get(place, replica=mine["id"])["points"][0][0] == 5
    refused = {"replica": theirs["id"]}
    assert ann.send("GET", f"/sequences/{project.sequence}/annotations", params=refused).status_code == 403
    assert ann.mark(project.sequence, 5, replica=theirs["id"]).status_code == 403

    assert reviewer.send("GET", place, params=refused).status_code == 403, "not before it was submitted"
    assert lead.mark(project.sequence, 5, replica=theirs["id"]).status_code == 403, "nobody marks for another"
    bob.act(theirs, "submit")
    assert reviewer.get(place, replica=theirs["id"])["points"][0][0] == 6
    assert ann.send("GET", place, params=refused).status_code == 403
    assert list_frames(reviewer, project.sequence) == [2, 3, 9]
    ann.act(mine, "submit")
    assert ann.send("GET", place).status_code == 403, "it may come back"
    reviewer.act(mine, "accept")
    assert list_frames(ann, project.sequence) == [2, 3, 9]


def test_machines_do_not_suggest_to_who_marks_blindly(lead, ann, bob, tracked) -> None:
    project = lead.make("/projects", name="Tracked")
    sequence = str(tracked.sequence_id)
    lead.send("PUT", f"/projects/{project['id']}/sequences/{sequence}")
    body = {"name": "Blind", "sequence_id": sequence, "frames": [2], "cameras": ["cam0"], "hands": ["right"]}
    lead.make(f"/projects/{project['id']}/replica-sets", **body, account_ids=[ann.id, bob.id])
    assert len(lead.get(f"/sequences/{sequence}/suggestions/cam0/2")["items"]) == 1
    assert len(lead.get(f"/sequences/{sequence}/suggestions/cam0/2/detector")["items"]) == 1
    assert ann.get(f"/sequences/{sequence}/suggestions/cam0/2")["items"] == []
    assert ann.get(f"/sequences/{sequence}/suggestions/cam0/2/detector")["items"] == []
    assert len(ann.get(f"/sequences/{sequence}/suggestions/cam0/3")["items"]) == 1
    fit = {"points": [[100 + 5 * joint, 100, 2] for joint in range(21)]}
    assert ann.send("POST", f"/sequences/{sequence}/suggestions/cam0/2/right/fit", fit).status_code == 403


def test_the_queue_of_frames_to_look_at_leaves_out_what_one_marks_blindly(lead, ann, bob, tracked) -> None:
    project = lead.make("/projects", name="Tracked")
    sequence = str(tracked.sequence_id)
    lead.send("PUT", f"/projects/{project['id']}/sequences/{sequence}")
    place = f"/sequences/{sequence}/annotations/cam0/2/right"
    points = [[x + 300, y, v] for x, y, v in lead.get(place)["points"]]
    body = {"points": points, "operation_id": str(uuid.uuid4())}
    assert lead.send("PUT", place, body, revision=1).status_code == 200
    body = {"name": "Blind", "sequence_id": sequence, "frames": [2], "cameras": ["cam0"], "hands": ["right"]}
    lead.make(f"/projects/{project['id']}/replica-sets", **body, account_ids=[ann.id, bob.id])
    everything, seen = (person.get(f"/sequences/{sequence}/frames-to-look-at") for person in (lead, ann))
    assert everything["items"][0]["frame"] == 2
    assert 2 not in {item["frame"] for item in seen["items"]}
    assert (seen["hands"], seen["doubtful"]) == (everything["hands"] - 1, everything["doubtful"] - 1)


def test_two_who_accepted_the_same_suggestion_do_not_agree(project, ann, bob, lead) -> None:
    made = project.replicate([ann, bob], [2, 5])
    accepted = {"kind": "interpolation", "label": "key frames 1 and 9"}
    for person, x in ((ann, 10.0), (bob, 13.0)):
        mine = assignments_of(person, made)
        for frame, sources in ((2, [None] * 20 + [accepted]), (5, [accepted] * 21)):
            by_hand = x if frame == 2 else 5.0
            points = [[by_hand if source is None else 5.0, 2 + 0.9 * joint, 2] for joint, source in enumerate(sources)]
            body = {"points": points, "sources": sources, "operation_id": str(uuid.uuid4())}
            place = f"/sequences/{project.sequence}/annotations/cam0/{frame}/right"
            options = {"headers": {"If-None-Match": "*"}, "params": {"replica": mine["id"]}}
            assert person.send("PUT", place, body, **options).status_code == 200
        person.act(mine, "submit")
    path = f"/replica-sets/{made['id']}/agreement"
    report = lead.get(path)
    assert report["overall"]["samples"] == 2 * 20 and report["pairs"][0]["joints"] == 20
    assert report["pairs"][0]["mean_px"] == pytest.approx(3.0)
    assert (report["left_out_joints"], report["source"]) == (2 * 22, ["independent"])
    words = "interpolated between key frames and not known to be free of a track"
    assert {one["words"]: one["joints"] for one in report["sources"]} == {"placed by hand": 40, words: 44}
    everything = lead.get(path, source="all")
    assert everything["overall"]["samples"] == 2 * 42 and everything["left_out_joints"] == 0
    assert f"44 joints are left out because of their source: 44 {words}." in lead.send("GET", f"{path}.html").text
    rows = list(csv.DictReader(io.StringIO(lead.send("GET", f"{path}.csv").text)))
    assert ("left out", words, "44") in {(row["of"], row["item"], row["samples"]) for row in rows}


def test_replicas_hold_their_places_only_and_lock_like_other_work(project, ann, bob) -> None:
    made = project.replicate([ann, bob], [2, 5])
    mine = assignments_of(ann, made)
    assert (mine["frames"], mine["frames_done"], mine["next_frame"]) == (2, 0, 2)
    assert ann.mark(project.sequence, 3, replica=mine["id"]).status_code == 404
    assert ann.mark(project.sequence, 2, hand="left", replica=mine["id"]).status_code == 404
    assert ann.mark(project.sequence, 2, replica=str(uuid.uuid4())).status_code == 404
    assert ann.mark(project.sequence, 2, replica="else").status_code == 422
    ann.mark(project.sequence, 2, replica=mine["id"])
    assert assignments_of(ann, made)["next_frame"] == 5
    ann.act(mine, "submit")
    locked = ann.mark(project.sequence, 5, replica=mine["id"])
    assert (locked.status_code, locked.json()["error"]) == (403, "LockedError")
    assert ann.get(f"/sequences/{project.sequence}")["annotated_frames"] == 0, "replicas are nobody's annotations"


def test_a_reviewer_who_marks_the_set_stays_blind(project, ann, reviewer, lead) -> None:
    made = project.replicate([ann, reviewer], [2])
    theirs = assignments_of(ann, made)
    ann.mark(project.sequence, 2, replica=theirs["id"])
    ann.act(theirs, "submit")
    place = f"/sequences/{project.sequence}/annotations/cam0/2/right"
    assert reviewer.send("GET", place, params={"replica": theirs["id"]}).status_code == 403
    assert reviewer.send("GET", f"/replica-sets/{made['id']}/agreement").status_code == 403
    assert reviewer.send("GET", f"/assignments/{theirs['id']}/comments").status_code == 403
    assert lead.get(f"/replica-sets/{made['id']}/agreement")["waiting"] == ["rob"]
    assert ann.send("GET", f"/replica-sets/{made['id']}/agreement").status_code == 403


def test_a_set_is_withdrawn_and_comes_back(project, ann, bob, join, lead) -> None:
    made = project.replicate([ann, bob], [2])
    mine = assignments_of(ann, made)
    ann.mark(project.sequence, 2, replica=mine["id"])
    assert lead.send("DELETE", f"/replica-sets/{made['id']}").status_code == 204
    assert ann.get("/assignments", mine=True)["items"] == []
    assert ann.mark(project.sequence, 2).status_code == 200
    assert lead.send("POST", f"/replica-sets/{made['id']}/restore").json()["annotators"] == 2
    assert list_frames(ann, project.sequence, replica=mine["id"]) == [2]
    cy = join("cy")
    assert lead.make(f"/replica-sets/{made['id']}/annotators", account_id=cy.id)["account"] == "cy"
    again = lead.send("POST", f"/replica-sets/{made['id']}/annotators", {"account_id": cy.id})
    assert again.status_code == 409


WRONG_SETS: tuple[dict[str, Any], ...] = (
    {"frames": []},
    {"frames": [1, 1]},
    {"frames": [12]},
    {"cameras": ["cam9"]},
    {"hands": ["third"]},
    {"account_ids": []},
    {"frames": list(range(2001))},
)


def test_sets_that_make_no_sense_are_refused(project, ann, bob, lead) -> None:
    body = {"name": "Set", "sequence_id": project.sequence, "frames": [1], "cameras": ["cam0"], "hands": ["right"]}
    body |= {"account_ids": [ann.id, bob.id]}
    for wrong in WRONG_SETS:
        answer = lead.send("POST", f"/projects/{project.id}/replica-sets", body | wrong)
        assert answer.status_code in (404, 422), wrong
    assert lead.get(f"/projects/{project.id}/replica-sets")["items"] == []


SIGMAS = (0.9, 1.3, 1.7, 2.3)


@pytest.mark.slow
def test_the_report_returns_the_noise_of_each_annotator(studio, join, lead, add_recording) -> None:
    sequence = add_recording("steady", frames=200, size=(640, 480), depth=False, color="jpg")["id"]
    project = lead.make("/projects", name="Agreement")
    lead.send("PUT", f"/projects/{project['id']}/sequences/{sequence}")
    people = [join(f"person{number}") for number in range(4)]
    body = {"name": "=Noise <b>", "sequence_id": sequence, "frames": list(range(200)), "cameras": ["cam0"]}
    body |= {"hands": ["right"], "account_ids": [person.id for person in people]}
    made = lead.make(f"/projects/{project['id']}/replica-sets", **body)

    rng = np.random.default_rng(5)
    truth = rng.uniform(150, 350, (200, 1, 2)) + rng.uniform(0, 120, (200, 21, 2))
    assignments = [assignments_of(person, made) for person in people]
    with studio.database.writing() as session:
        for assignment, sigma in zip(assignments, SIGMAS, strict=True):
            for frame in range(200):
                if rng.random() < 0.05:
                    continue
                marked = truth[frame] + rng.normal(size=(21, 2)) * sigma
                v = np.where(rng.random((21, 1)) < 0.1, 0, 2)
                points = [[x, y, int(v)] for x, y, v in np.hstack([marked, v]).tolist()]
                place = Place(uuid.UUID(sequence), "cam0", frame, "right", assignment["id"])
                change_annotation(session, place, Change("put", points, None, uuid.uuid4(), LOCAL_ACCOUNT_ID))
    path = f"/replica-sets/{made['id']}/agreement"
    assert lead.get(path)["overall"]["std_px"] is None
    for person, assignment in zip(people, assignments, strict=True):
        person.act(assignment, "submit")

    report = lead.get(path)
    assert [person["spread"]["std_px"] for person in report["annotators"]] == pytest.approx(SIGMAS, rel=0.05)
    assert report["overall"]["std_px"] == pytest.approx(np.sqrt(np.mean(np.square(SIGMAS))), rel=0.05)
    assert report["radial_px"] == pytest.approx(np.sqrt(2) * report["overall"]["std_px"])
    assert 0 < report["oks"] < 1
    assert len(report["worst"]) == 50
    values = [place["spread"]["std_px"] for place in report["worst"]]
    assert values == sorted(values, reverse=True)

    rows = list(csv.DictReader(io.StringIO(lead.send("GET", f"{path}.csv").text)))
    overall = next(row for row in rows if row["of"] == "overall")
    assert float(overall["std_px"]) == report["overall"]["std_px"]
    page = lead.send("GET", f"{path}.html")
    assert "=Noise &lt;b&gt;" in page.text
    assert "<b>" not in page.text.replace("<body", "")
    assert not any(word in page.text for word in ("<script", "http", "src="))
    assert "sandbox" in page.headers["content-security-policy"]
    assert json.dumps(report)


def test_tracks_and_evaluations_are_closed_to_who_marks_blindly_until_it_is_accepted(
    lead, ann, bob, reviewer, tracked
) -> None:
    project = lead.make("/projects", name="Tracked")
    sequence, track = str(tracked.sequence_id), str(tracked.track_id)
    lead.send("PUT", f"/projects/{project['id']}/sequences/{sequence}")
    body = {"name": "Week 1", "sequence_id": sequence, "frames": [2], "cameras": ["cam0"], "hands": ["right"]}
    made = lead.make(f"/projects/{project['id']}/replica-sets", **body, account_ids=[ann.id, lead.id])
    paths = [
        f"/tracks/{track}/frames",
        f"/tracks/{track}/frames/2/energy",
        f"/tracks/{track}/joints",
        f"/tracks/{track}/cameras/cam0/frames/2/overlay.png",
        f"/tracks/{track}/files/track.npz",
        f"/tracks/{track}/export/csv",
        f"/tracks/{track}/evaluation",
        f"/tracks/{track}/evaluation/now-0/cam0/2/right.jpg",
        f"/evaluations?track={track}",
        f"/evaluations?sequence={sequence}",
        f"/evaluations?project={project['id']}",
        f"/evaluations/report.csv?track={track}",
    ]
    for path in paths:
        answer = ann.send("GET", path)
        assert answer.status_code == 403, path
        assert "Week 1" in answer.json()["detail"]
        assert bob.send("GET", path).status_code != 403, "who does not mark it sees it"
    assert ann.send("POST", "/viewer-sessions", {"track_id": track, "frame": 0}).status_code == 403
    mine = assignments_of(ann, made)
    ann.act(mine, "submit")
    assert ann.send("GET", paths[0]).status_code == 403, "it may come back"
    reviewer.act(mine, "accept")
    assert ann.send("GET", paths[0]).status_code == 200


def test_key_frames_of_a_blind_replica_are_its_annotators(project, ann, bob) -> None:
    made = project.replicate([ann, bob], [2, 5])
    mine = assignments_of(ann, made)
    path = f"/sequences/{project.sequence}/key-frames"
    place = f"{path}/cam0/2/right"
    assert ann.send("PUT", place).status_code == 403, "not among everybody's while it is marked blindly"
    assert ann.send("PUT", place, params={"replica": mine["id"]}).status_code == 204
    assert bob.send("PUT", place, params={"replica": mine["id"]}).status_code == 403
    assert bob.send("GET", path, params={"replica": mine["id"]}).status_code == 403
    assert len(ann.get(path, replica=mine["id"])["items"]) == 1
    assert ann.get(path)["items"] == []
