"""One step up or down a chain: what a thing was made from is what it was made of, seen from the other side."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from sqlalchemy.orm import Session

from server.database import Database
from server.lineage.schemas import Kind
from server.lineage.steps import AT_ONCE, Ids, Step, find_results, find_sources
from tests.server.lineage.chains import Chains, make_model, make_registration, make_scan, store_chains
from tests.server.rows import keep


@pytest.fixture
def database_kind() -> str:
    return "sqlite"


SOURCES = {
    "registration": {"scan", "first"},
    "rest": {"other", "first"},
    "anew": {"scan", "second"},
    "decision": {"registration"},
    "chosen": {"decision", "registration"},
    "second": {"chosen", "first"},
    "laid": {"moving"},
    "finer": {"moving", "laid"},
    "begun": {"moving", "person"},
    "stretch": {"laid"},
    "refused": {"laid"},
    "bodies": {"stretch", "laid"},
    "person": {"bodies"},
}
"""What each thing was made from; the others were made from nothing."""


def step_from(chains: Chains, step: Callable[[Session, Kind, Ids], Step], session: Session, name: str) -> set[str]:
    kind, row = chains.things[name]
    reached = step(session, kind, {row.id})
    return {chains.name(kind, id_) for kind, ids in reached for id_ in ids if id_ is not None}


def test_everything_names_what_it_was_made_from(database: Database) -> None:
    chains = store_chains(database)
    with database.reading() as session:
        found = {name: step_from(chains, find_sources, session, name) for name in chains.things}
    assert {name: sources for name, sources in found.items() if sources} == SOURCES


def test_everything_names_what_was_made_of_it(database: Database) -> None:
    chains = store_chains(database)
    expected: dict[str, set[str]] = {}
    for name, sources in SOURCES.items():
        for source in sources:
            expected.setdefault(source, set()).add(name)
    expected["laid"].remove("bodies")  # which is reached by the decision about it alone
    with database.reading() as session:
        found = {name: step_from(chains, find_results, session, name) for name in chains.things}
    assert {name: results for name, results in found.items() if results} == expected


@pytest.mark.parametrize("step", [find_sources, find_results])
def test_several_things_together_reach_what_each_of_them_does(database: Database, step: Callable) -> None:
    chains = store_chains(database)
    with database.reading() as session:
        for names in (["registration", "anew", "rest"], ["first", "second"], ["laid", "begun"]):
            kind = chains.things[names[0]][0]
            reached = step(session, kind, {chains.id(name) for name in names})
            together = {chains.name(at, id_) for at, ids in reached for id_ in ids if id_ is not None}
            assert together == set().union(*(step_from(chains, step, session, name) for name in names))


def test_of_nothing_nothing_is_reached(database: Database) -> None:
    with database.reading() as session:
        for kind in ("scan", "registration", "training_set", "hand_model", "body_set", "moving_registration"):
            for step in (find_sources, find_results):
                assert [id_ for _, ids in step(session, kind, set()) for id_ in ids] == []


def test_more_ids_than_one_query_takes_are_all_looked_up(database: Database) -> None:
    model = make_model("first", 0)
    scans = [make_scan(f"{number}") for number in range(AT_ONCE + 1)]
    made = [make_registration(scan, model) for scan in scans]
    keep(database, model)
    with database.writing() as session:
        session.add_all(scans)
        session.flush()
        session.add_all(made)
    with database.reading() as session:
        [(kind, ids)] = find_results(session, "scan", {scan.id for scan in scans})
        sources = dict(find_sources(session, "registration", {row.id for row in made}))
    assert kind == "registration" and sorted(ids) == sorted(row.id for row in made)  # type: ignore[type-var]
    assert sorted(sources["scan"]) == sorted(scan.id for scan in scans)  # type: ignore[type-var]
    assert set(sources["hand_model"]) == {model.id}
