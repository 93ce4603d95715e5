"""`/lineage`: from a scan to the model and back."""

from __future__ import annotations

import uuid

from server.hand_models.models import HandModelRow
from server.hand_models.storing import UNTRAINED_ID
from tests.server.curation import Curation, curation, join

__all__ = ["curation", "join"]


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
