"""Whole chains: each thing once, in words for people, and no more of it than the reader may see."""

from __future__ import annotations

import uuid
from datetime import timedelta

import pytest

from server.access.models import LOCAL_ACCOUNT_ID
from server.database import Database, utc_now
from server.errors import NotFoundError
from server.lineage.schemas import Lineage
from server.lineage.service import MOST_ITEMS, find_lineage
from tests.server.lineage.chains import Chains, make_decision, make_registration, store_chains
from tests.server.rows import keep, make_person


@pytest.fixture
def database_kind() -> str:
    return "sqlite"


def look(database: Database, chains: Chains, name: str, reader_id: uuid.UUID = LOCAL_ACCOUNT_ID) -> Lineage:
    with database.reading() as session:
        return find_lineage(session, chains.things[name][0], chains.id(name), reader_id)


def names_of(chains: Chains, groups: list) -> set[str]:
    return {chains.name(group.kind, item.id) for group in groups for item in group.items}


def test_what_is_above_one_thing_has_that_thing_below_it(database: Database) -> None:
    chains = store_chains(database)
    above, below = set(), set()
    for name in chains.things:
        told = look(database, chains, name)
        above |= {(name, other) for other in names_of(chains, told.comes_from)}
        below |= {(other, name) for other in names_of(chains, told.went_into)}
    assert above == below
    assert {other for name, other in above if name == "anew"} == {
        "scan", "second", "first", "chosen", "decision", "registration",
    }  # fmt: skip
    assert {other for name, other in above if name == "begun"} == {"moving", "person", "bodies", "stretch", "laid"}


def test_the_nearest_kinds_come_first_and_each_kind_once(database: Database) -> None:
    chains = store_chains(database)
    told = look(database, chains, "anew")
    kinds = [group.kind for group in told.comes_from]
    assert kinds == ["scan", "hand_model", "training_set", "decision", "registration"]
    assert [group.total for group in told.comes_from] == [1, 2, 1, 1, 1] and told.went_into == []


def test_every_kind_is_told_in_words(database: Database) -> None:
    chains = store_chains(database)
    told = {name: look(database, chains, name).of for name in chains.things}
    assert {name: of.id for name, of in told.items()} == {name: chains.id(name) for name in chains.things}
    assert {name: (of.name, of.detail) for name, of in told.items()} == {
        "scan": ("scan", "Ada flat"),
        "other": ("other", "hands"),
        "registration": ("scan", "good, by first"),
        "rest": ("other", "good, by first"),
        "anew": ("scan", "doubtful, by second"),
        "decision": ("accept by local", "of a registration by first"),
        "chosen": ("chosen", "1 registration, 1 subject"),
        "first": ("first", "trained, round 0"),
        "second": ("second", "trained, round 1"),
        "moving": ("Ada waves", "Ada, 3 frames"),
        "laid": ("Ada waves", "frames 0 to 2, prior mixture"),
        "finer": ("Ada waves", "frames 1 to 2, prior none"),
        "begun": ("Ada waves", "frames 0 to 2, prior mixture"),
        "stretch": ("accept by local", "frames 0 to 1"),
        "refused": ("reject by local", "frames 0 to 2"),
        "bodies": ("bodies", "1 frame"),
        "person": ("person", "1 frame"),
    }


def test_a_decision_that_a_second_reviewer_must_not_see_is_not_counted_for_them(database: Database) -> None:
    chains = store_chains(database)
    first, second = make_person("rob", "reviewer"), make_person("eve", "reviewer")
    model, scan = chains.things["first"][1], chains.things["other"][1]
    hidden = make_registration(scan, model, needs_second=True, reviewer_count=1, sole_reviewer_id=first.id)
    decision = make_decision(hidden, account_id=first.id)
    keep(database, first, second, hidden, decision)
    chains.things |= {"hidden": ("registration", hidden), "blind": ("decision", decision)}
    assert names_of(chains, look(database, chains, "hidden", first.id).went_into) == {"blind"}
    assert look(database, chains, "blind", first.id).of.name == "accept by rob"
    assert sum(group.total for group in look(database, chains, "hidden", second.id).went_into) == 0
    with pytest.raises(NotFoundError, match=f"There is no decision {decision.id}"):
        look(database, chains, "blind", second.id)


def test_the_newest_are_shown_and_all_are_counted(database: Database) -> None:
    chains = store_chains(database)
    made = [make_decision(chains.things["rest"][1], number) for number in range(1, MOST_ITEMS + 3)]
    for number, row in enumerate(made):
        row.created_at = utc_now() + timedelta(seconds=number)
    with database.writing() as session:
        session.add_all(made)
    [group] = look(database, chains, "rest").went_into
    assert group.total == MOST_ITEMS + 2
    assert [item.id for item in group.items] == [row.id for row in reversed(made)][:MOST_ITEMS]


def test_what_there_is_not_is_named_by_its_kind(database: Database) -> None:
    unknown = uuid.uuid4()
    with database.reading() as session, pytest.raises(NotFoundError, match=f"There is no training set {unknown}"):
        find_lineage(session, "training_set", unknown, LOCAL_ACCOUNT_ID)
