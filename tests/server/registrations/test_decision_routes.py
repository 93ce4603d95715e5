"""Decisions: nothing is lost, nothing done twice, and who is to decide blindly sees nothing."""

from __future__ import annotations

import uuid
from concurrent.futures import ThreadPoolExecutor
from datetime import timedelta

import pytest
from hypothesis import given
from hypothesis import strategies as st
from sqlalchemy import func, select

from server.database import utc_now
from server.registrations.decision_models import DecisionRow
from server.registrations.decisions import find_standing
from server.registrations.review import compute_kappa
from tests.server.curation import Curation, curation, join

__all__ = ["curation", "join"]


def test_the_likeliest_failures_come_first_and_leave_the_queue_when_decided(curation: Curation) -> None:
    ids = {name: curation.register(name, score) for name, score in [("a", 0.2), ("b", 0.9), ("c", 0.5), ("d", 0.9)]}
    order = {"queue": "undecided", "order": "likely_failures"}
    queue = curation.queue(curation.rob, **order)
    assert set(queue[:2]) == {"b", "d"} and queue[2:] == ["c", "a"]
    first = curation.rob.get("/registrations", limit=2, **order)
    curation.decide(curation.rob, ids[queue[0]], "reject", reasons=["fingers_swapped", "finger_off"])
    assert curation.queue(curation.rob, **order) == queue[1:]
    assert curation.queue(curation.rob, **order, cursor=first["next_cursor"]) == queue[2:]
    counts = curation.rob.get("/registrations/counts")
    assert counts == {"undecided": 3, "flagged": 0, "second": 0, "all": 4, "accept": 0, "reject": 1, "unsure": 0}


def test_a_decision_keeps_its_author_its_time_and_the_model_it_judged(curation: Curation) -> None:
    id_ = curation.register("a")
    answer = curation.decide(curation.rob, id_, "reject", reasons=["other"], note="thumb", seconds=1.5)
    assert answer.status_code == 201, answer.text
    [made] = curation.rob.get(f"/registrations/{id_}/decisions")["items"]
    assert made == answer.json()["decision"]
    assert (made["author_name"], made["model_name"]) == ("rob", "Untrained right hand")
    assert (made["reasons"], made["note"], made["seconds"], made["stands"]) == (["other"], "thumb", 1.5, True)
    assert made["model_id"] == curation.look(curation.rob, id_)["model_id"]


def test_a_page_that_dies_after_sending_loses_nothing_and_does_nothing_twice(curation: Curation) -> None:
    """The answer never arrives; the page, opened again, sends what its journal holds once more."""
    id_, body = curation.register("a"), {"operation_id": str(uuid.uuid4()), "note": "x"}
    first = curation.decide(curation.rob, id_, **body)
    later = curation.decide(curation.rob, id_, "reject")
    again = curation.decide(curation.rob, id_, **body)
    assert (first.status_code, later.status_code, again.status_code) == (201, 201, 200)
    assert again.json()["decision"]["id"] == first.json()["decision"]["id"]
    assert curation.look(curation.rob, id_)["decision"] == "reject", "what came later still counts"
    undo = str(uuid.uuid4())
    taken = [curation.undo(curation.rob, later.json()["decision"]["id"], undo) for _ in range(2)]
    assert [answer.status_code for answer in taken] == [201, 200]
    with curation.studio.database.reading() as session:
        assert session.scalar(select(func.count()).select_from(DecisionRow)) == 3


def test_a_decision_sent_many_times_at_once_is_one(curation: Curation) -> None:
    id_, operation = curation.register("a"), str(uuid.uuid4())
    with ThreadPoolExecutor(6) as pool:
        send = [pool.submit(curation.decide, curation.rob, id_, operation_id=operation) for _ in range(6)]
        answers = [sent.result() for sent in send]
    assert sorted(answer.status_code for answer in answers) == [200] * 5 + [201]
    assert len({answer.json()["decision"]["id"] for answer in answers}) == 1


def test_one_operation_is_no_other_decision(curation: Curation) -> None:
    one, other, operation = curation.register("a"), curation.register("b"), str(uuid.uuid4())
    assert curation.decide(curation.rob, one, operation_id=operation).status_code == 201
    for person, id_, decision in (
        (curation.rob, one, "reject"),
        (curation.rob, other, "accept"),
        (curation.eve, one, "accept"),
    ):
        assert curation.decide(person, id_, decision, operation_id=operation).status_code == 422
    assert curation.look(curation.rob, other)["decision"] is None


def test_undo_brings_back_what_one_thought_before_and_stays_in_the_history(curation: Curation) -> None:
    id_ = curation.register("a")
    first = curation.decide(curation.rob, id_, "accept").json()["decision"]
    second = curation.decide(curation.rob, id_, "reject").json()["decision"]
    done = curation.undo(curation.rob, second["id"]).json()
    assert (done["decision"]["decision"], done["decision"]["undoes_id"]) == ("undo", second["id"])
    assert done["registration"]["decision"] == "accept"
    assert done["registration"]["my_decision_id"] == first["id"]
    assert curation.undo(curation.rob, second["id"]).status_code == 409
    assert curation.undo(curation.rob, done["decision"]["id"]).status_code == 409
    assert curation.undo(curation.eve, first["id"]).status_code == 403
    assert curation.undo(curation.rob, first["id"]).json()["registration"]["decision"] is None
    history = curation.rob.get(f"/registrations/{id_}/decisions")["items"]
    assert [item["decision"] for item in history] == ["undo", "undo", "reject", "accept"]
    assert not any(item["stands"] for item in history)
    assert curation.queue(curation.rob, queue="undecided") == ["a"]


@given(st.lists(st.tuples(st.integers(0, 2), st.sampled_from(["accept", "reject", "unsure", "undo"])), max_size=12))
def test_what_stands_is_each_persons_last_decision_not_taken_back(acts: list[tuple[int, str]]) -> None:
    people = [uuid.UUID(int=n) for n in range(3)]
    history: list[DecisionRow] = []
    stacks: dict[uuid.UUID, list[DecisionRow]] = {person: [] for person in people}
    for who, what in acts:
        person = people[who]
        if what == "undo" and not stacks[person]:
            continue
        undoes = stacks[person].pop().id if what == "undo" else None
        made = DecisionRow(id=uuid.uuid4(), account_id=person, number=len(history) + 1, decision=what, undoes_id=undoes)
        history.append(made)
        if what != "undo":
            stacks[person].append(made)
    expected = {person: stack[-1].decision for person, stack in stacks.items() if stack}
    assert {made.account_id: made.decision for made in find_standing(history)} == expected


def test_a_second_reviewer_sees_nothing_of_the_first_until_they_have_decided(curation: Curation) -> None:
    rob, eve = curation.rob, curation.eve
    ids = [curation.register(name) for name in "ab"]
    assert curation.lead.send("POST", "/curation/second-reviews", {"share": 0.5}).json() == {"marked": 1, "already": 0}
    [id_] = [one for one in ids if curation.look(rob, one)["needs_second"]]
    first = curation.decide(rob, id_, "unsure", note="secret").json()["decision"]
    hidden = curation.look(eve, id_)
    assert (hidden["decision"], hidden["is_hidden"], hidden["my_decision"]) == (None, True, None)
    for path, params in (
        (f"/registrations/{id_}/decisions", {}),
        ("/decisions", {}),
        ("/decisions", {"account_id": rob.id}),
        ("/registrations", {"decision": "unsure"}),
        ("/registrations", {"queue": "flagged"}),
    ):
        assert eve.get(path, **params)["items"] == [], path
    lineage = eve.get(f"/lineage/scan/{hidden['scan']['id']}")
    assert "unsure" not in str(lineage) and "secret" not in str(lineage)
    assert eve.send("GET", f"/lineage/decision/{first['id']}").status_code == 404
    assert eve.get("/registrations/counts")["unsure"] == 0
    assert curation.queue(eve, queue="second") == [hidden["scan"]["name"]] and curation.queue(rob, queue="second") == []
    assert len(rob.get(f"/registrations/{id_}/decisions")["items"]) == 1
    second = curation.decide(eve, id_, "reject").json()
    assert second["decision"]["is_blind"] and not second["registration"]["is_hidden"]
    assert len(eve.get(f"/registrations/{id_}/decisions")["items"]) == 2
    agreement = eve.get("/curation/agreement")
    assert (agreement["both"], agreement["share_agreed"], agreement["disputed"]) == (1, 0.0, [str(id_)])


def test_agreement_counts_blind_decisions_only_and_kappa_is_cohens(curation: Curation) -> None:
    said = [("accept", "accept")] * 4 + [("reject", "reject")] * 2 + [("accept", "reject"), ("reject", "accept")]
    ids = [curation.register(f"s{number}") for number in range(len(said) + 1)]
    curation.decide(curation.rob, ids[-1], "accept")
    curation.decide(curation.eve, ids[-1], "accept")  # she saw his
    curation.lead.send("POST", "/curation/second-reviews", {})
    for id_, (first, second) in zip(ids, said, strict=False):
        curation.decide(curation.rob, id_, first)
        curation.decide(curation.eve, id_, second)
    found = curation.rob.get("/curation/agreement")
    assert (found["both"], found["share_agreed"], found["waiting"]) == (8, 0.75, 0)
    by_chance = (5 / 8) * (5 / 8) + (3 / 8) * (3 / 8)
    assert found["kappa"] == pytest.approx((0.75 - by_chance) / (1 - by_chance))
    [pair] = found["pairs"]
    assert pair["both"] == 8 and pair["table"]["accept"]["accept"] == 4


def test_kappa_is_one_in_full_agreement_nothing_by_chance_and_none_without_choice() -> None:
    assert compute_kappa({("accept", "accept"): 3, ("reject", "reject"): 2}) == pytest.approx(1.0)
    half = {(a, b): 5 for a in ("accept", "reject") for b in ("accept", "reject")}
    assert compute_kappa(half) == pytest.approx(0.0)
    assert compute_kappa({("accept", "accept"): 9}) is None and compute_kappa({}) is None


def test_throughput_counts_the_time_at_work_and_not_the_pauses(curation: Curation) -> None:
    ids = [curation.register(f"s{number}") for number in range(4)]
    for id_ in ids:
        curation.decide(curation.rob, id_)
    began = utc_now() - timedelta(minutes=30)
    with curation.studio.database.writing() as session:
        rows = session.scalars(select(DecisionRow).order_by(DecisionRow.created_at)).all()
        for row, seconds in zip(rows, (0, 2, 4, 904), strict=True):
            row.created_at = began + timedelta(seconds=seconds)
    since = (began - timedelta(seconds=1)).isoformat()
    [person] = curation.rob.get("/curation/throughput", since=since)["people"]
    assert (person["name"], person["decisions"], person["accept"]) == ("rob", 4, 4)
    assert person["active_minutes"] == pytest.approx(4 / 60) and person["per_minute"] == pytest.approx(30.0)
    assert curation.rob.send("GET", "/curation/throughput", params={"since": "2026-01-01T00:00:00"}).status_code == 422


def test_throughput_does_not_count_a_decision_that_was_taken_back(curation: Curation) -> None:
    a, b = curation.register("a"), curation.register("b")
    curation.decide(curation.rob, a)
    rejected = curation.decide(curation.rob, b, "reject").json()["decision"]
    curation.undo(curation.rob, rejected["id"])
    [person] = curation.rob.get("/curation/throughput")["people"]
    assert [person[name] for name in ("decisions", "accept", "reject", "undone")] == [1, 1, 0, 1]
    curation.decide(curation.rob, b, "reject")
    [person] = curation.rob.get("/curation/throughput")["people"]
    assert [person[name] for name in ("decisions", "accept", "reject", "undone")] == [2, 1, 1, 1]


def test_annotators_do_not_decide_and_unknown_reasons_are_named(curation: Curation, join) -> None:
    id_ = curation.register("a")
    assert curation.decide(join("ann"), id_).status_code == 403
    assert "wrong_pose" in curation.decide(curation.rob, id_, reasons=["ugly"]).json()["detail"]
    assert curation.decide(curation.rob, id_, "perhaps").status_code == 422
    assert curation.decide(curation.rob, uuid.uuid4()).status_code == 404
    assert [item["key"] for item in curation.rob.get("/curation/reasons")["items"]] == list("123456789")
