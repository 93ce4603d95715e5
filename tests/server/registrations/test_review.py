"""How alike and how fast people decide, worked out from the rows of their decisions."""

from __future__ import annotations

import uuid
from datetime import UTC, datetime, timedelta

import pytest

from server.database import Database
from server.registrations.decision_models import DecisionRow
from server.registrations.models import RegistrationRow
from server.registrations.review import _count_pairs, compute_kappa, measure_agreement, measure_throughput
from tests.server.registrations.test_service import Bench

NOON = datetime(2026, 1, 2, 12, 0, tzinfo=UTC)


@pytest.fixture
def bench(database: Database) -> Bench:
    return Bench(database)


def decide(bench: Bench, id_: uuid.UUID, person: uuid.UUID, decision: str, second: float = 0.0, **more) -> DecisionRow:
    row = DecisionRow(
        registration_id=id_,
        account_id=person,
        model_id=bench.model,
        number=more.pop("number", 1),
        decision=decision,
        reasons=[],
        note="",
        is_blind=more.pop("is_blind", True),
        operation_id=uuid.uuid4(),
        created_at=NOON + timedelta(seconds=second),
        **more,
    )
    bench.add(row)
    return row


def judge_twice(bench: Bench, name: str, first: str, second: str) -> uuid.UUID:
    """A registration that rob and eve decide about without seeing each other."""
    id_ = bench.register(bench.scan(name))
    made = [decide(bench, id_, bench.rob, first), decide(bench, id_, bench.eve, second, number=2)]
    with bench.database.writing() as session:
        row = session.get_one(RegistrationRow, id_)
        row.reviewer_count = 2
        row.standing = {str(one.account_id): {"id": str(one.id), "decision": one.decision} for one in made}
    return id_


def test_agreement_is_that_of_the_pairs_and_names_what_is_disputed(bench: Bench) -> None:
    for number in range(3):
        judge_twice(bench, f"same {number}", "accept", "accept")
    judge_twice(bench, "both bad", "reject", "reject")
    disputed = judge_twice(bench, "disputed", "accept", "reject")
    waiting = bench.register(bench.scan("waiting"), needs_second=True, reviewer_count=1)
    with bench.database.reading() as session:
        found = measure_agreement(session, None)
        elsewhere = measure_agreement(session, "another collection")
    assert waiting and (found.both, found.share_agreed, found.waiting) == (5, 0.8, 1)
    [pair] = found.pairs
    assert {pair.first_name, pair.second_name} == {"rob", "eve"} and pair.both == 5
    rob_first = pair.first_name == "rob"
    assert pair.table["accept" if rob_first else "reject"]["reject" if rob_first else "accept"] == 1
    # 0.8 seen; by chance 0.8 * 0.6 + 0.2 * 0.4 = 0.56
    assert found.kappa == pytest.approx((0.8 - 0.56) / (1.0 - 0.56)) and pair.kappa == found.kappa
    assert found.disputed == [disputed]
    assert (elsewhere.both, elsewhere.share_agreed, elsewhere.pairs) == (0, None, [])


def test_what_was_taken_back_or_decided_in_sight_does_not_count(bench: Bench) -> None:
    id_ = judge_twice(bench, "a", "accept", "reject")
    with bench.database.writing() as session:
        row = session.get_one(RegistrationRow, id_)
        row.standing = {key: entry for key, entry in row.standing.items() if entry["decision"] == "accept"}
    with bench.database.reading() as session:
        found = measure_agreement(session, None)
    assert (found.both, found.disputed) == (0, [])


def test_three_people_are_three_pairs(bench: Bench) -> None:
    people = [uuid.UUID(int=number) for number in range(3)]
    rows = [DecisionRow(account_id=person, decision=what) for person, what in zip(people, "aab", strict=True)]
    tables = _count_pairs([rows, rows])
    assert tables == {
        (people[0], people[1]): {("a", "a"): 2},
        (people[0], people[2]): {("a", "b"): 2},
        (people[1], people[2]): {("a", "b"): 2},
    }


@pytest.mark.parametrize(
    ("table", "kappa"),
    [
        ({}, None),
        ({("a", "a"): 4}, None),
        ({("a", "a"): 2, ("b", "b"): 2}, 1.0),
        ({("a", "a"): 1, ("a", "b"): 1, ("b", "a"): 1, ("b", "b"): 1}, 0.0),
        ({("a", "b"): 2, ("b", "a"): 2}, -1.0),
    ],
    ids=["nothing", "no choice", "always", "by chance", "never"],
)
def test_kappa_is_cohens(table, kappa) -> None:
    assert compute_kappa(table) == (kappa if kappa is None else pytest.approx(kappa))


def test_a_pause_is_no_work_and_what_was_taken_back_no_decision(bench: Bench) -> None:
    ids = [bench.register(bench.scan(str(number))) for number in range(4)]
    first = decide(bench, ids[0], bench.rob, "accept", 0.0)
    decide(bench, ids[1], bench.rob, "reject", 30.0)
    decide(bench, ids[2], bench.rob, "unsure", 30.0 + 3600.0)
    decide(bench, ids[0], bench.rob, "undo", 30.0 + 3630.0, number=2, undoes_id=first.id)
    decide(bench, ids[3], bench.eve, "accept", 0.0)
    with bench.database.reading() as session:
        people = measure_throughput(session, NOON - timedelta(days=1)).people
        later = measure_throughput(session, NOON + timedelta(minutes=30)).people
    rob, eve = people
    assert (rob.name, rob.decisions, rob.accept, rob.reject, rob.unsure, rob.undone) == ("rob", 2, 0, 1, 1, 1)
    assert (rob.active_minutes, rob.per_minute) == (pytest.approx(1.0), pytest.approx(2.0))
    assert (eve.decisions, eve.active_minutes, eve.per_minute) == (1, 0.0, None)
    assert [person.name for person in later] == ["rob"]
