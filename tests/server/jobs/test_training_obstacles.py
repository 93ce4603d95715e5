"""What keeps a hand model from being trained, told before a job is made: who is missing, and what does not fit."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from fastapi.testclient import TestClient

from server.hand_models.models import HandModelRow
from server.hand_models.storing import UNTRAINED_ID
from server.jobs.train_schemas import TrainCreate
from server.jobs.training_obstacles import list_test_subjects
from server.registrations.training_set_schemas import TrainingRule
from tests.server.conftest import GeneratedHand, Studio
from tests.server.curation import add_registered, make_true_hand
from tests.server.jobs.test_obstacles import API, accept, may_start, refused


def test_those_to_judge_on_are_who_was_asked_for_else_who_was_left_out_each_once_in_order() -> None:
    rule = TrainingRule(leave_out_subjects=["Zoe", "Ada", "Zoe"])

    def judged(asked: list[str], by: TrainingRule) -> list[str]:
        return list_test_subjects(TrainCreate(name="hand", rule=by, test_subjects=asked), by)

    assert judged([], rule) == ["Ada", "Zoe"]
    assert judged(["Bob", "Ada", "Bob"], rule) == ["Ada", "Bob"]
    assert judged([], TrainingRule()) == []


def test_training_says_how_many_registrations_and_people_are_missing(
    client: TestClient, studio: Studio, generated_hand: GeneratedHand, tmp_path: Path
) -> None:
    hands = [make_true_hand(tmp_path / str(pose), 1, pose) for pose in (0, 5, 9, 20)]
    rule = {"by": "decisions"}
    body = {"name": "Our hand", "rule": rule}
    assert "There are 0 registrations of 0 people; a model needs 20" in refused(client, "/train", body)
    for number in range(6):
        add_registered(studio.app, hands[number % 4], f"a{number}", subject=f"S{number % 2}")
    told = refused(client, "/train", body)
    assert "There are 0 registrations of 0 people" in told
    assert "6 registrations wait for a decision on the page Curate." in told
    accept(studio)
    assert refused(client, "/train", body) == (
        "There are 6 registrations of 2 people; a model needs 20 of at least 2 people. Register and accept more scans."
    )
    for number in range(17):
        add_registered(studio.app, hands[number % 4], f"b{number}", subject="S0")
    for number in range(2):
        add_registered(studio.app, hands[number], f"c{number}", subject="S7")
    accept(studio)
    told = refused(client, "/train", {**body, "rule": {**rule, "leave_out_subjects": ["S1"]}})
    assert "There are 20 registrations of 1 person; a model needs 20 of at least 2 people" in told
    assert "2 registrations do not count: a hand needs at least 3 of its own." in told
    for left_out, tested, said in (
        ([], [], "Nobody is kept for testing"),
        ([], ["S1"], "S1 is in the training set"),
        (["S9"], ["S9"], "S9 has no registration that was accepted"),
    ):
        asked = {**body, "rule": {**rule, "leave_out_subjects": left_out}, "evaluate": "quick"}
        assert said in refused(client, "/train", {**asked, "test_subjects": tested})
    may_start(client, "/train", body)
    [kept] = client.get(f"{API}/training-sets").json()["items"]
    assert (kept["name"], kept["registration_count"], kept["subject_count"]) == ("Our hand", 25, 3)
    assert client.post(f"{API}/jobs/train", json={"name": "x"}).status_code == 422


def test_training_needs_the_same_mesh_a_right_hand_and_fingers_that_bend(
    client: TestClient, studio: Studio, generated_hand: GeneratedHand
) -> None:
    for number in range(20):
        add_registered(studio.app, generated_hand, f"{number}", subject=f"S{number % 2}")
    body = {"name": "Our hand", "rule": {"by": "verdict"}}
    assert "The hands hardly move" in refused(client, "/train", body), "all are of one scan"
    with studio.database.writing() as session:
        untrained = session.get_one(HandModelRow, UNTRAINED_ID)
        columns = {
            "kind": "uploaded",
            "digest": untrained.digest,
            "facts": {**untrained.facts, "vertices": 778},
            "report": None,
        }
        other = HandModelRow(name="MANO", side="left", **columns)
        session.add(other)
        session.flush()
        folder = studio.app.state.storage.folder("models", other.id)
        folder.mkdir()
        (folder / "model.npz").write_bytes(
            (studio.app.state.storage.folder("models", UNTRAINED_ID) / "model.npz").read_bytes()
        )
    told = refused(client, "/train", {**body, "model_id": str(other.id)})
    assert "MANO is a left hand; training begins with a right one" in told
    assert f"Some registrations have {untrained.facts['vertices']} vertices, MANO has 778" in told
    (folder / "model.npz").write_bytes(b"x")
    assert "missing or was changed" in refused(client, "/train", {**body, "model_id": str(other.id)})


def test_a_loop_needs_scans_enough_that_training_could_work(
    client: TestClient, studio: Studio, generated_hand: GeneratedHand
) -> None:
    body: dict[str, Any] = {"name": "Our hand"}
    assert "There are no scans" in refused(client, "/loop", body)
    for number in range(20):
        add_registered(studio.app, generated_hand, f"{number}", subject=f"S{number % 3}")
    for more, told in (
        ({"leave_out_subjects": ["S0"]}, "There are 13 registrations of 2 people; a model needs 20"),
        ({"by": "decisions"}, "20 registrations wait for a decision on the page Curate."),
        ({"by": "decisions", "rounds": 2}, "by people's decisions it is 1"),
        ({"evaluate": "quick"}, "Nobody is kept for testing"),
        ({"evaluate": "quick", "leave_out_subjects": ["Zoe"]}, "There is no scan of Zoe"),
    ):
        assert told in refused(client, "/loop", {**body, **more})
    may_start(client, "/loop", body)
