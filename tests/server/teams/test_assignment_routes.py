"""`/assignments`: lists by what one asks, and a change that comes late is answered with how the work is now."""

from __future__ import annotations

import uuid
from typing import Any

import pytest


@pytest.fixture
def database_kind() -> str:
    """One will do: what people do at once is asked of the assignments."""
    return "sqlite"


def spans(person: Any, **asked: Any) -> list[tuple[int, int]]:
    return [(item["frame_first"], item["frame_last"]) for item in person.get("/assignments", **asked)["items"]]


def test_assignments_are_listed_oldest_first_by_person_project_recording_and_state(project, ann, bob, lead) -> None:
    first, second, third = project.assign(ann, 0, 2), project.assign(bob, 3, 5), project.assign(ann, 6, 8)
    ann.act(third, "submit")
    assert spans(lead) == spans(lead, project=project.id, sequence=project.sequence) == [(0, 2), (3, 5), (6, 8)]
    assert spans(ann, mine=True) == [(0, 2), (6, 8)] and spans(lead, mine=True) == []
    assert spans(lead, state="submitted") == [(6, 8)] and spans(ann, mine=True, state="open") == [(0, 2)]
    assert spans(lead, project=str(uuid.uuid4())) == spans(lead, sequence=str(uuid.uuid4())) == []
    page = lead.get("/assignments", limit=2)
    assert [item["id"] for item in page["items"]] == [first["id"], second["id"]]
    assert [item["id"] for item in lead.get("/assignments", cursor=page["next_cursor"])["items"]] == [third["id"]]


def test_every_answer_carries_the_revision_that_the_next_change_needs(project, ann, lead) -> None:
    given = project.assign(ann, 0, 2)
    path = f"/assignments/{given['id']}"
    assert lead.send("GET", path).headers["etag"] == f'"{given["revision"]}"'
    changed = lead.send("PATCH", path, {"note": "the left hand too"}, revision=given["revision"])
    assert changed.headers["etag"] == f'"{changed.json()["revision"]}"' != f'"{given["revision"]}"'
    assert changed.json()["note"] == "the left hand too"


def test_a_change_of_an_older_revision_is_answered_with_how_it_is_now(project, ann, lead) -> None:
    given = project.assign(ann, 0, 2)
    now, path = ann.act(given, "submit"), f"/assignments/{given['id']}"
    for method, act, body in (
        ("PATCH", "", {"note": "x"}),
        ("DELETE", "", None),
        ("POST", "/accept", None),
        ("POST", "/return", {"text": "x"}),
    ):
        late = lead.send(method, path + act, body, revision=given["revision"])
        assert late.status_code == 409 and late.headers["etag"] == f'"{now["revision"]}"'
        assert (late.json()["theirs"]["state"], late.json()["theirs"]["revision"]) == ("submitted", now["revision"])
        assert lead.send(method, path + act, body).status_code == 428, "it must say which revision it changes"
    assert lead.get(path)["state"] == "submitted"


def test_a_comment_is_dealt_with_on_its_own_assignment_only(project, ann, reviewer) -> None:
    given, other = project.assign(ann, 0, 2), project.assign(ann, 3, 5)
    made = reviewer.make(f"/assignments/{given['id']}/comments", text="the thumb", frame=1)
    assert reviewer.send("POST", f"/assignments/{other['id']}/comments/{made['id']}/resolve").status_code == 404
    done = ann.send("POST", f"/assignments/{given['id']}/comments/{made['id']}/resolve").json()
    assert (done["resolved_by"], done["author"]) == ("ann", "rob")
    again = ann.send("POST", f"/assignments/{given['id']}/comments/{made['id']}/reopen").json()
    assert again["resolved_by"] is None
    assert ann.get(f"/assignments/{given['id']}/comments")["items"] == [again]
