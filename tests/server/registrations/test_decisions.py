"""Decisions as rows: numbered, blind or not, told apart by who asks, and copied to their registration."""

from __future__ import annotations

import uuid

import pytest
from sqlalchemy.orm import Session

from server.database import Database
from server.errors import ConflictError, ForbiddenError, InvalidError, NotFoundError
from server.registrations.decision_models import DecisionRow
from server.registrations.decision_schemas import DecisionMake
from server.registrations.decisions import (
    decide,
    describe_decisions,
    find_standing,
    list_decisions,
    list_history,
    undo,
)
from server.registrations.models import RegistrationRow
from tests.server.registrations.test_service import Bench


@pytest.fixture
def bench(database: Database) -> Bench:
    return Bench(database)


def choose(bench: Bench, id_: uuid.UUID, person: uuid.UUID, decision="accept", operation=None, **more) -> DecisionRow:
    made = DecisionMake(decision=decision, operation_id=operation or uuid.uuid4(), **more)
    with bench.database.writing() as session:
        return decide(session, id_, person, made)[0]


def take_back(bench: Bench, decision_id: uuid.UUID, person: uuid.UUID) -> DecisionRow:
    with bench.database.writing() as session:
        return undo(session, decision_id, person, uuid.uuid4())[0]


def look(bench: Bench, id_: uuid.UUID) -> tuple[str | None, int, uuid.UUID | None]:
    """What counts of a registration, how many people's decision stands, and who decided while it is one."""
    with bench.database.reading() as session:
        row = session.get_one(RegistrationRow, id_)
        return row.decision, row.reviewer_count, row.sole_reviewer_id


def ask(session: Session, reader: uuid.UUID, **wanted) -> list[uuid.UUID]:
    rows, _ = list_decisions(session, wanted.get("author"), wanted.get("about"), reader, None, 100)
    return [row.id for row in rows]


def test_decisions_are_numbered_from_one_for_each_registration(bench: Bench) -> None:
    first, second = (bench.register(bench.scan(name)) for name in "ab")
    numbers = [choose(bench, id_, person).number for id_ in (first, second) for person in (bench.rob, bench.eve)]
    assert numbers == [1, 2, 1, 2]
    with bench.database.reading() as session:
        assert [row.number for row in list_history(session, first)] == [1, 2]
        assert list_history(session, uuid.uuid4()) == []


def test_a_registration_has_the_newest_decision_that_stands_and_names_its_only_judge(bench: Bench) -> None:
    id_ = bench.register(bench.scan("a"))
    choose(bench, id_, bench.rob, "accept")
    assert look(bench, id_) == ("accept", 1, bench.rob)
    choose(bench, id_, bench.rob, "unsure")
    assert look(bench, id_) == ("unsure", 1, bench.rob), "the same person counts once"
    made = choose(bench, id_, bench.eve, "reject")
    assert look(bench, id_) == ("reject", 2, None)
    take_back(bench, made.id, bench.eve)
    assert look(bench, id_) == ("unsure", 1, bench.rob)


def test_who_decides_first_or_cannot_see_the_other_is_blind_and_the_next_is_not(bench: Bench) -> None:
    seen, hidden = bench.register(bench.scan("a")), bench.register(bench.scan("b"), needs_second=True)
    for id_, is_second_blind in ((seen, False), (hidden, True)):
        assert choose(bench, id_, bench.rob).is_blind
        assert choose(bench, id_, bench.rob, "reject").is_blind, "one's own decision tells nobody anything new"
        assert choose(bench, id_, bench.eve).is_blind == is_second_blind
        assert not choose(bench, id_, bench.eve, "unsure").is_blind


def test_a_decision_of_nobody_about_nothing_cannot_be_taken_back(bench: Bench) -> None:
    id_ = bench.register(bench.scan("a"))
    made = choose(bench, id_, bench.rob)
    unknown = uuid.uuid4()
    with pytest.raises(NotFoundError, match=f"There is no decision {unknown}"):
        take_back(bench, unknown, bench.rob)
    with pytest.raises(ForbiddenError, match="Make a decision of your own instead: the last one counts"):
        take_back(bench, made.id, bench.eve)
    taken = take_back(bench, made.id, bench.rob)
    with pytest.raises(ConflictError, match="This is an undo already; decide again instead"):
        take_back(bench, taken.id, bench.rob)
    with pytest.raises(ConflictError, match="This decision was already undone"):
        take_back(bench, made.id, bench.rob)
    assert look(bench, id_) == (None, 0, None)


def test_an_operation_used_for_something_else_is_refused_and_changes_nothing(bench: Bench) -> None:
    one, other, operation = *(bench.register(bench.scan(name)) for name in "ab"), uuid.uuid4()
    choose(bench, one, bench.rob, "reject", operation, reasons=["slid"], note="x")
    told = f"The operation {operation} belongs to another decision; nothing was stored. Make a new operation_id"
    for id_, person, more in (
        (one, bench.rob, {"decision": "reject", "reasons": ["slid"], "note": "y"}),
        (one, bench.rob, {"decision": "reject", "reasons": [], "note": "x"}),
        (one, bench.eve, {"decision": "reject", "reasons": ["slid"], "note": "x"}),
        (other, bench.rob, {"decision": "reject", "reasons": ["slid"], "note": "x"}),
    ):
        with pytest.raises(InvalidError, match=told):
            choose(bench, id_, person, operation=operation, **more)
    assert (look(bench, one), look(bench, other)) == (("reject", 1, bench.rob), (None, 0, None))


def test_who_is_to_decide_unseen_finds_none_of_the_others_decisions(bench: Bench) -> None:
    plain, hidden = bench.register(bench.scan("a")), bench.register(bench.scan("b"), needs_second=True)
    first, second = (choose(bench, id_, bench.rob).id for id_ in (plain, hidden))
    with bench.database.reading() as session:
        assert ask(session, bench.rob) == [second, first], "the newest first, and one's own"
        assert ask(session, bench.eve) == [first]
        assert ask(session, bench.eve, about=hidden) == ask(session, bench.eve, author=bench.eve) == []
    own = choose(bench, hidden, bench.eve, "reject").id
    with bench.database.reading() as session:
        assert ask(session, bench.eve) == [own, second, first]
        assert ask(session, bench.eve, author=bench.rob, about=hidden) == [second]


def test_a_decision_is_described_with_its_author_and_whether_it_stands(bench: Bench) -> None:
    id_ = bench.register(bench.scan("a"))
    old, new = choose(bench, id_, bench.rob, "accept"), choose(bench, id_, bench.rob, "reject", reasons=["slid"])
    with bench.database.reading() as session:
        told = describe_decisions(session, [new, old])
        assert describe_decisions(session, []) == []
    assert [(one.id, one.author_name, one.model_name, one.stands) for one in told] == [
        (new.id, "rob", "hand", True),
        (old.id, "rob", "hand", False),
    ]


def test_what_stands_comes_in_the_order_it_was_made_however_the_rows_lie() -> None:
    people = [uuid.uuid4() for _ in range(3)]
    rows = [
        DecisionRow(id=uuid.uuid4(), account_id=person, number=number, decision="accept", undoes_id=None)
        for number, person in enumerate([people[0], people[1], people[0], people[2]], start=1)
    ]
    assert [row.number for row in find_standing(rows[::-1])] == [2, 3, 4]
    assert find_standing([]) == []
