"""`/snapshots`: blind annotators read no labels through them, and only leads make one current again."""

from __future__ import annotations

import json
import uuid

import pytest

from tests.server.conftest import Studio
from tests.server.teams.conftest import Join, Person, Project, ann, bob, join, lead, project

__all__ = ["ann", "bob", "join", "lead", "project"]


def keep_labels(person: Person, project: Project, name: str = "now") -> dict:
    answer = person.send("POST", f"/sequences/{project.sequence}/labels/snapshots", {"name": name})
    assert answer.is_success, answer.text
    return answer.json()


def test_a_blind_annotator_sees_of_a_snapshot_what_is_not_their_own_work(
    project: Project, ann: Person, bob: Person, lead: Person
) -> None:
    for frame in (1, 2):
        assert lead.mark(project.sequence, frame).status_code == 200
    snapshot = keep_labels(lead, project)
    for frame in (1, 2):
        address = f"/sequences/{project.sequence}/annotations/cam0/{frame}/right"
        assert lead.send("DELETE", address, revision=1).is_success
    project.replicate([ann, bob], [2, 5])
    address = f"/snapshots/{snapshot['id']}"
    refused = ann.send("GET", f"{address}/labels.json")
    assert refused.status_code == 403 and "marking frames of this recording blind" in refused.json()["detail"]
    assert [item["frame"] for item in ann.get(f"{address}/compare")["items"]] == [1]
    assert [item["frame"] for item in lead.get(f"{address}/compare")["items"]] == [1, 2]
    assert ann.get(f"{address}/verify")["is_intact"] and ann.get(address)["item_count"] == 2


def test_a_snapshot_is_downloaded_under_a_name_that_says_which(project: Project, lead: Person, studio: Studio) -> None:
    assert lead.mark(project.sequence, 1).status_code == 200
    first = keep_labels(lead, project, "first")
    answer = lead.send("GET", f"/snapshots/{first['id']}/labels.json")
    assert f"waving-labels-v1-{first['content_hash'][:12]}.json" in answer.headers["content-disposition"]
    assert [item["frame"] for item in json.loads(answer.content)["items"]] == [1]
    assert lead.send("DELETE", f"/sequences/{project.sequence}").is_success
    assert lead.send("GET", f"/snapshots/{first['id']}/labels.json").content == answer.content, "of a deleted one too"
    assert lead.send("POST", f"/snapshots/{first['id']}/restore").status_code == 404


@pytest.mark.parametrize(("role", "status"), [("annotator", 403), ("reviewer", 403), ("lead", 200)])
def test_only_leads_restore_and_everybody_may_keep(project: Project, join: Join, role: str, status: int) -> None:
    person = join(f"the {role}", role)  # type: ignore[arg-type]
    assert person.mark(project.sequence, 1).status_code == 200
    snapshot = keep_labels(person, project, "mine")
    assert (snapshot["author"], snapshot["version"], snapshot["name"]) == (f"the {role}", 1, "mine")
    assert person.send("POST", f"/snapshots/{snapshot['id']}/restore").status_code == status


def test_a_snapshot_that_there_is_not_is_said_at_every_address(lead: Person) -> None:
    address = f"/snapshots/{uuid.uuid4()}"
    for method, tail in (
        ("GET", ""),
        ("GET", "/labels.json"),
        ("GET", "/verify"),
        ("GET", "/compare"),
        ("POST", "/restore"),
    ):
        answer = lead.send(method, address + tail)
        assert answer.status_code == 404 and "There is no snapshot" in answer.json()["detail"], tail
