"""Projects hold recordings; what is put away comes back."""

from __future__ import annotations

import uuid


def test_a_project_is_made_renamed_put_away_and_brought_back(lead, ann) -> None:
    made = lead.make("/projects", name=" Grasps ", description="Two people, six objects")
    path = f"/projects/{made['id']}"
    assert (made["name"], made["recordings"], made["assignments"]["open"]) == ("Grasps", 0, 0)
    renamed = lead.send("PATCH", path, {"name": "Grasps of objects"}, revision=1)
    assert (renamed.json()["name"], renamed.headers["etag"]) == ("Grasps of objects", '"2"')
    late = lead.send("PATCH", path, {"name": "Other"}, revision=1)
    assert (late.status_code, late.json()["theirs"]["name"]) == (409, "Grasps of objects")
    assert lead.send("DELETE", path).status_code == 204
    assert ann.get("/projects")["items"] == []
    assert [item["id"] for item in ann.get("/projects", archived=True)["items"]] == [made["id"]]
    assert lead.send("POST", f"{path}/restore").json()["archived_at"] is None
    assert [item["id"] for item in ann.get("/projects")["items"]] == [made["id"]]


def test_two_projects_do_not_share_a_name(lead) -> None:
    lead.make("/projects", name="One")
    other = lead.make("/projects", name="Two")
    assert lead.send("POST", "/projects", {"name": "One"}).status_code == 409
    assert lead.send("PATCH", f"/projects/{other['id']}", {"name": "One"}, revision=1).status_code == 409
    assert lead.get(f"/projects/{other['id']}")["name"] == "Two"


def test_projects_that_make_no_sense_are_refused(lead) -> None:
    for body in ({"name": " "}, {"name": "a\nb"}, {"name": "x" * 201}, {"name": "a", "more": 1}, {}):
        assert lead.send("POST", "/projects", body).status_code == 422
    assert lead.get("/projects")["items"] == []


def test_projects_come_in_pages(lead) -> None:
    names = [lead.make("/projects", name=f"Project {number}")["name"] for number in range(5)]
    page = lead.get("/projects", limit=3)
    rest = lead.get("/projects", limit=3, cursor=page["next_cursor"])
    assert [item["name"] for item in (*page["items"], *rest["items"])] == names[::-1]
    assert rest["next_cursor"] is None
    assert lead.send("GET", "/projects", params={"cursor": "WyJhIl0"}).status_code == 404


def test_recordings_are_in_projects_and_leave_when_nothing_of_them_is_assigned(project, lead, ann) -> None:
    given = project.assign(ann, 0, 4)
    [recording] = ann.get(f"/projects/{project.id}/sequences")["items"]
    assert (recording["frame_count"], recording["assigned_frames"], recording["accepted_frames"]) == (12, 5, 0)
    path = f"/projects/{project.id}/sequences/{project.sequence}"
    assert lead.send("PUT", path).status_code == 204, "twice is once"
    assert lead.send("DELETE", path).status_code == 409
    lead.send("DELETE", f"/assignments/{given['id']}", revision=1)
    assert lead.send("DELETE", path).status_code == 204
    assert ann.get(f"/projects/{project.id}/sequences")["items"] == []
    body = {"sequence_id": project.sequence, "account_id": ann.id, "frame_first": 0, "frame_last": 1}
    assert lead.send("POST", f"/projects/{project.id}/assignments", body).status_code == 409


def test_a_project_put_away_holds_nobody_up_but_keeps_what_was_accepted(project, lead, ann, bob) -> None:
    finished, open_ = project.assign(ann, 0, 2), project.assign(ann, 3, 5)
    ann.act(finished, "submit")
    lead.act(finished, "accept")
    lead.send("DELETE", f"/projects/{project.id}")
    assert bob.mark(project.sequence, 1).status_code == 403
    assert bob.mark(project.sequence, 4).status_code == 200
    assert ann.get("/assignments", mine=True)["items"] == []
    lead.send("POST", f"/projects/{project.id}/restore")
    assert bob.mark(project.sequence, 5).status_code == 403
    assert open_["id"] in [item["id"] for item in ann.get("/assignments", mine=True, state="open")["items"]]


def test_people_are_listed_by_name_in_pages(lead, ann, bob) -> None:
    page = lead.get("/people", limit=2)
    rest = lead.get("/people", limit=100, cursor=page["next_cursor"])
    assert [(item["name"], item["role"]) for item in (*page["items"], *rest["items"])] == [
        ("ann", "annotator"),
        ("bob", "annotator"),
        ("lea", "lead"),
        ("local", "admin"),
    ]


def test_what_is_not_there_is_not_found(lead) -> None:
    nobody = uuid.uuid4()
    for path in ("projects", "assignments", "replica-sets"):
        assert lead.send("GET", f"/{path}/{nobody}").status_code == 404
