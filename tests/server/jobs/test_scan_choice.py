"""Scans that a job registers: those asked for by name, without what is done, in the order of their names."""

from __future__ import annotations

import uuid
from typing import Any

import pytest

from server.database import Database, utc_now
from server.errors import NotFoundError
from server.hand_models.models import HandModelRow
from server.jobs import scan_choice
from server.jobs.loop_schemas import LoopCreate
from server.jobs.register_schemas import RegisterCreate
from server.jobs.scan_choice import choose_scans, list_loop_scans
from server.registrations.models import RegistrationRow
from server.scans.models import ScanRow
from tests.server.registrations.test_service import Bench


@pytest.fixture
def database_kind() -> str:
    """One will do: what is asked here are plain queries."""
    return "sqlite"


@pytest.fixture
def bench(database: Database) -> Bench:
    return Bench(database)


def choose(bench: Bench, **asked: Any) -> list[str]:
    """Names of the scans that are chosen."""
    with bench.database.reading() as session:
        ids = choose_scans(session, RegisterCreate(**asked), bench.model)
        return [session.get_one(ScanRow, id_).name for id_ in ids]


def test_all_scans_come_by_name_without_deleted_ones(bench: Bench) -> None:
    for name in ("c", "a", "b"):
        bench.scan(name)
    bench.scan("0", deleted_at=utc_now())
    assert choose(bench) == choose(bench, only="all") == ["a", "b", "c"]


def test_collection_and_subject_narrow_the_choice_together(bench: Bench) -> None:
    for name, collection, subject in (("a", "Lab", "Ada"), ("b", "Lab", "Bob"), ("c", "Home", "Ada")):
        bench.scan(name, collection=collection, subject=subject)
    assert choose(bench, collection="Lab") == ["a", "b"] and choose(bench, subject="Ada") == ["a", "c"]
    assert choose(bench, collection="Lab", subject="Ada") == ["a"] and choose(bench, collection="Nowhere") == []


def test_new_are_those_that_this_model_has_not_registered_as_they_are_cropped_now(bench: Bench) -> None:
    scans = {name: bench.scan(name) for name in ("done", "cropped since", "untouched", "by another model")}
    for name in ("done", "cropped since", "by another model"):
        registered = bench.register(scans[name])
    other = bench.add(HandModelRow(name="other", kind="trained", side="right", digest="1" * 64, facts={}))
    with bench.database.writing() as session:
        session.get_one(ScanRow, scans["cropped since"]).revision = 2
        session.get_one(RegistrationRow, registered).model_id = other
    assert choose(bench) == ["by another model", "cropped since", "untouched"]


def test_not_accepted_are_those_whose_newest_registration_nobody_accepted(bench: Bench) -> None:
    scans = {name: bench.scan(name) for name in ("accepted", "rejected", "undecided", "newer since", "untouched")}
    bench.register(scans["accepted"], decision="accept")
    bench.register(scans["rejected"], decision="reject")
    bench.register(scans["undecided"])
    bench.register(scans["newer since"], decision="accept")
    bench.register(scans["newer since"])
    assert choose(bench, only="not_accepted") == ["newer since", "rejected", "undecided", "untouched"]


@pytest.mark.parametrize("at_once", [1, 2, 500])
def test_scans_asked_for_by_id_come_by_name_once_each_however_many_are_looked_up_at_a_time(
    bench: Bench, monkeypatch, at_once: int
) -> None:
    monkeypatch.setattr(scan_choice, "AT_ONCE", at_once)
    a, b, c = (bench.scan(name) for name in "abc")
    bench.register(c)
    assert choose(bench, scan_ids=[b, c, b, a], only="all") == ["a", "b", "c"]
    assert choose(bench, scan_ids=[b, c, a]) == ["a", "b"], "what is done is left out all the same"


def test_scans_that_are_not_there_are_named_and_counted(bench: Bench) -> None:
    there, gone = bench.scan("a"), bench.scan("b", deleted_at=utc_now())
    unknown = [uuid.uuid4() for _ in range(3)]
    with pytest.raises(NotFoundError, match=rf"There is no scan {gone}\."):
        choose(bench, scan_ids=[there, gone])
    with pytest.raises(NotFoundError, match=rf"There is no scan {unknown[0]}, nor 1 other\."):
        choose(bench, scan_ids=[*unknown[:2], there])
    with pytest.raises(NotFoundError, match=rf"There is no scan {unknown[0]}, nor 2 others\."):
        choose(bench, scan_ids=unknown)


def test_a_loop_goes_over_every_scan_of_its_collection_registered_or_not(bench: Bench) -> None:
    scans = [bench.scan(name, collection="Lab") for name in "ba"]
    bench.register(scans[0], decision="accept")
    bench.scan("elsewhere", collection="Home")
    with bench.database.reading() as session:
        assert list_loop_scans(session, LoopCreate(name="hand", collection="Lab")) == scans[::-1]
        assert len(list_loop_scans(session, LoopCreate(name="hand"))) == 3
