"""`/lineage`: from a scan to the model and back, from a moving scan to the person's model and back."""

from __future__ import annotations

import uuid
from typing import Any

import pytest

from server.hand_models.models import HandModelRow
from server.hand_models.storing import UNTRAINED_ID
from server.moving_scans.models import MovingRegistrationRow
from tests.server.curation import Curation, curation, join
from tests.server.moving_scans.curated import Curated, curated, moving_person
from tests.server.moving_scans.moving import MovingPerson, add
from tests.server.moving_scans.people import keep, lay, person
from tests.server.teams.conftest import Join, Person

__all__ = ["curated", "curation", "join", "moving_person"]


def test_a_scan_leads_to_the_model_and_the_model_back_to_the_scan(curation: Curation) -> None:
    id_, other = curation.register("a"), curation.register("b")
    decision = curation.decide(curation.rob, id_).json()["decision"]
    made = curation.rob.send("POST", "/training-sets", {"name": "set"}).json()
    model = HandModelRow(
        name="trained",
        kind="trained",
        side="right",
        digest="0" * 64,
        facts={},
        round=1,
        parent_id=UNTRAINED_ID,
        training_set_id=uuid.UUID(made["id"]),
        report=None,
    )
    with curation.studio.database.writing() as session:
        session.add(model)
    scan_id = curation.look(curation.rob, id_)["scan"]["id"]
    down = curation.rob.get(f"/lineage/scan/{scan_id}")
    assert [group["kind"] for group in down["went_into"]] == ["registration", "decision", "training_set", "hand_model"]
    assert down["comes_from"] == []
    up = curation.rob.get(f"/lineage/hand_model/{model.id}")
    found = {group["kind"]: {item["id"] for item in group["items"]} for group in up["comes_from"]}
    assert found == {
        "training_set": {made["id"]},
        "decision": {decision["id"]},
        "registration": {str(id_)},
        "scan": {scan_id},
        "hand_model": {str(UNTRAINED_ID)},
    }
    assert str(other) not in str(up)
    assert curation.rob.send("GET", f"/lineage/scan/{uuid.uuid4()}").status_code == 404
    assert curation.rob.send("GET", f"/lineage/thing/{uuid.uuid4()}").status_code == 422


def test_what_a_second_reviewer_must_not_see_is_neither_listed_nor_counted(curation: Curation) -> None:
    rob, eve, id_ = curation.rob, curation.eve, curation.register("a")
    assert curation.lead.send("POST", "/curation/second-reviews", {"share": 1.0}).json()["marked"] == 1
    first = curation.decide(rob, id_, "accept").json()["decision"]

    def decisions(person: Person) -> list[str]:
        groups = person.get(f"/lineage/registration/{id_}")["went_into"]
        found = [group for group in groups if group["kind"] == "decision"]
        assert all(group["total"] == len(group["items"]) for group in found)
        return [item["id"] for group in found for item in group["items"]]

    assert decisions(rob) == [first["id"]] and decisions(eve) == []
    assert eve.send("GET", f"/lineage/decision/{first['id']}").status_code == 404
    second = curation.decide(eve, id_, "accept").json()["decision"]
    assert decisions(eve) == decisions(rob) == [second["id"], first["id"]]
    assert eve.get(f"/lineage/decision/{first['id']}")["of"]["name"] == "accept by rob"


def test_a_set_is_led_back_to_its_scan_and_the_scan_leads_to_the_set(curated: Curated) -> None:
    first = curated.decide(curated.rob, curated.first, "accept", 0, 1).json()
    refused = curated.decide(curated.rob, curated.second, "reject", 1, 1).json()
    asked = {"moving_scan_id": curated.scan_id, "name": "For the model"}
    kept = curated.rob.send("POST", "/body-sets", asked).json()
    up = curated.ann.get(f"/lineage/body_set/{kept['id']}")
    assert up["of"]["name"] == "For the model" and up["went_into"] == []
    found = {group["kind"]: {item["id"] for item in group["items"]} for group in up["comes_from"]}
    assert found == {
        "stretch_decision": {first["id"]},
        "moving_registration": {curated.first},
        "moving_scan": {curated.scan_id},
    }
    down = curated.ann.get(f"/lineage/moving_scan/{curated.scan_id}")
    assert down["comes_from"] == []
    found = {group["kind"]: {item["id"] for item in group["items"]} for group in down["went_into"]}
    assert found == {
        "moving_registration": {curated.first, curated.second},
        "stretch_decision": {first["id"], refused["id"]},
        "body_set": {kept["id"]},
    }
    assert curated.ann.get(f"/lineage/stretch_decision/{refused['id']}")["went_into"] == [], "of no set"
    assert curated.ann.get(f"/lineage/stretch_decision/{first['id']}")["of"] == {
        "kind": "stretch_decision",
        "id": first["id"],
        "name": "accept by rob",
        "detail": "frames 0 to 1",
        "created_at": first["created_at"],
    }
    again = curated.ann.get(f"/lineage/moving_registration/{curated.second}")["comes_from"]
    assert {group["kind"] for group in again} == {"moving_scan", "moving_registration"}
    missing = curated.ann.send("GET", f"/lineage/body_set/{first['id']}")
    assert missing.status_code == 404
    assert missing.json()["detail"] == f"There is no body set {first['id']}."


def test_a_set_keeps_the_decisions_it_was_made_by_when_they_are_taken_back(curated: Curated) -> None:
    first = curated.decide(curated.rob, curated.first, "accept", 0, 1).json()
    second = curated.decide(curated.rob, curated.second, "accept", 2, 2).json()
    asked = {"moving_scan_id": curated.scan_id, "name": "Both"}
    both = curated.rob.send("POST", "/body-sets", asked).json()
    curated.undo(curated.rob, second)
    one = curated.rob.send("POST", "/body-sets", asked | {"name": "One"}).json()
    for decision, sets in ((first, {both["id"], one["id"]}), (second, {both["id"]})):
        [group] = curated.ann.get(f"/lineage/stretch_decision/{decision['id']}")["went_into"]
        assert (group["kind"], {item["id"] for item in group["items"]}) == ("body_set", sets)
    groups = curated.ann.get(f"/lineage/body_set/{both['id']}")["comes_from"]
    told = {group["kind"]: {(item["name"], item["detail"]) for item in group["items"]} for group in groups}
    assert told == {
        "stretch_decision": {("accept by rob", "frames 0 to 1"), ("accept by rob", "frames 2 to 2")},
        "moving_registration": {
            ("Ada waves", "frames 0 to 2, prior mixture"),
            ("Ada waves", "frames 1 to 2, prior none"),
        },
        "moving_scan": {("Ada waves", "Ada, 3 frames")},
    }
    assert curated.ann.get(f"/lineage/body_set/{one['id']}")["of"]["detail"] == "2 frames"


def test_of_many_things_the_newest_fifty_are_listed_and_all_are_counted(curated: Curated) -> None:
    made = [curated.decide(curated.rob, curated.first, "accept", 0, frame % 3).json()["id"] for frame in range(52)]
    groups = curated.ann.get(f"/lineage/moving_scan/{curated.scan_id}")["went_into"]
    [decisions] = [group for group in groups if group["kind"] == "stretch_decision"]
    assert decisions["total"] == 52
    assert [item["id"] for item in decisions["items"]] == made[:1:-1]


def groups(told: dict[str, Any], way: str) -> dict[str, set[str]]:
    return {group["kind"]: {item["id"] for item in group["items"]} for group in told[way]}


@pytest.mark.slow
def test_the_model_leads_back_to_the_decisions_and_on_to_the_registration_that_begins_with_it(
    curated: Curated, moving_person: MovingPerson, join: Join
) -> None:
    lea = join("lea", "lead")
    registration = lay(curated, moving_person, person(0.5), range(3))
    decision = curated.decide(curated.rob, registration, "accept", 0, 1).json()
    kept = keep(curated, "Ada's frames")
    model = curated.rob.send("POST", f"/body-sets/{kept['id']}/model").json()
    files = {f"later{name}": data for name, data in list(moving_person.files.items())[1:]}
    later = add(curated.studio, files, subject="Ada")
    stranger = add(curated.studio, dict(list(moving_person.files.items())[:1]), subject="Bo")
    for scan_id, offered in ((curated.scan_id, [model]), (later["id"], [model]), (stranger["id"], [])):
        assert curated.ann.get("/person-models", moving_scan_id=scan_id)["items"] == offered
    assert curated.ann.get("/person-models")["items"] == [model]

    asked = {"kind": "register_moving", "moving_scan_id": later["id"], "person_model_id": model["id"]}
    for wrong, why in (
        ({"parent_id": registration, "moving_scan_id": curated.scan_id}, "Leave one of the two out"),
        ({"person_model_id": kept["id"]}, "no model of a person"),
    ):
        refused = lea.send("POST", "/jobs", asked | wrong)
        assert refused.status_code == 422 and why in refused.text
    job = lea.send("POST", "/jobs", asked)
    assert job.status_code == 201, job.text
    assert job.json()["params"]["population"] == "female"
    assert job.json()["title"].endswith("with the model Ada's frames, mixture prior")
    with curated.studio.database.writing() as session:
        row = session.get_one(MovingRegistrationRow, uuid.UUID(registration))
        next_one = MovingRegistrationRow(
            **{
                column.name: getattr(row, column.name)
                for column in MovingRegistrationRow.__table__.columns
                if column.name not in ("id", "moving_scan_id", "template_id", "created_at")
            },
            id=uuid.uuid4(),
            moving_scan_id=uuid.UUID(later["id"]),
            template_id=uuid.UUID(model["id"]),
        )
        session.add(next_one)

    told = curated.ann.get(f"/lineage/person_model/{model['id']}")
    assert (told["of"]["name"], told["of"]["detail"]) == ("Ada's frames", "2 frames")
    assert groups(told, "comes_from") == {
        "body_set": {kept["id"]},
        "stretch_decision": {decision["id"]},
        "moving_registration": {registration},
        "moving_scan": {curated.scan_id},
    }
    assert groups(told, "went_into") == {"moving_registration": {str(next_one.id)}}
    back = groups(curated.ann.get(f"/lineage/moving_registration/{next_one.id}"), "comes_from")
    assert back["person_model"] == {model["id"]} and back["stretch_decision"] == {decision["id"]}
    on = groups(curated.ann.get(f"/lineage/stretch_decision/{decision['id']}"), "went_into")
    assert on["person_model"] == {model["id"]} and on["moving_registration"] == {str(next_one.id)}
