"""Queues of registrations, and which registration of a scan stands."""

from __future__ import annotations

import uuid
from typing import Any

import pytest

from server.access.models import Account
from server.database import Database
from server.errors import NotFoundError
from server.hand_models.models import HandModelRow
from server.registrations.models import RegistrationRow
from server.registrations.service import (
    RegistrationFilter,
    add_registration,
    count_registrations,
    find_newest,
    get_registration,
    is_hidden,
    list_registrations,
    settle_current,
)
from server.scans.models import ScanRow


class Bench:
    """Scans, a model and people, as rows alone."""

    def __init__(self, database: Database) -> None:
        self.database = database
        self.model = self.add(HandModelRow(name="hand", kind="trained", side="right", digest="0" * 64, facts={}))
        self.rob, self.eve = (self.add(Account(name=name, role="reviewer")) for name in ("rob", "eve"))

    def add(self, row: Any) -> uuid.UUID:
        with self.database.writing() as session:
            session.add(row)
            session.flush()
            return row.id

    def scan(self, name: str, **columns: Any) -> uuid.UUID:
        shared = {"collection": "hands", "subject": "Ada", "pose": "flat", "file": "scan.ply", "byte_count": 1}
        counts = {"point_count": 9, "face_count": 0, "has_colors": False, "extent_m": [0.1] * 3, "notes": []}
        return self.add(ScanRow(name=name, digest=uuid.uuid4().hex * 2, **(shared | counts | columns)))

    def register(self, scan: uuid.UUID, score: float = 0.1, verdict: str = "good", **columns: Any) -> uuid.UUID:
        row = RegistrationRow(
            scan_id=scan,
            model_id=self.model,
            round=1,
            crop_revision=1,
            digest="0" * 64,
            side="right",
            verdict=verdict,
            score=score,
            reasons=[],
            scan_to_mesh_mm={},
            seconds=1.0,
            **columns,
        )
        with self.database.writing() as session:
            return add_registration(session, row).id

    def queue(self, name: Any, order: Any = "likely_failures", reader: uuid.UUID | None = None) -> list[uuid.UUID]:
        with self.database.reading() as session:
            asked = (RegistrationFilter(), name, order, reader or self.rob, None, 100)
            return [row.id for row in list_registrations(session, *asked)[0]]


@pytest.fixture
def bench(database: Database) -> Bench:
    return Bench(database)


def test_a_newer_registration_of_a_scan_takes_the_place_of_the_older(bench: Bench) -> None:
    scan, other = bench.scan("a"), bench.scan("b")
    older, newer, third = bench.register(scan), bench.register(scan), bench.register(other)
    with bench.database.reading() as session:
        current = {id_: get_registration(session, id_).is_current for id_ in (older, newer, third)}
        found = find_newest(session, [scan, other, uuid.uuid4()])
    assert current == {older: False, newer: True, third: True}
    assert {id_: found_of["registration"]["id"] for id_, found_of in found.items()} == {scan: newer, other: third}


def test_the_worst_come_first_and_pages_hold_each_once(bench: Bench) -> None:
    scores = [0.3, 0.9, 0.3, 0.1]
    made = [bench.register(bench.scan(str(n)), score) for n, score in enumerate(scores)]
    worst_first = sorted(zip(scores, map(str, made), strict=True), reverse=True)
    seen, cursor = [], None
    with bench.database.reading() as session:
        while True:
            asked = (RegistrationFilter(), "all", "likely_failures", bench.rob, cursor, 1)
            rows, cursor = list_registrations(session, *asked)
            seen += [(row.score, str(row.id)) for row in rows]
            if cursor is None:
                break
    assert seen == worst_first
    assert bench.queue("all", "newest") == made[::-1]


def test_who_is_to_decide_unseen_sees_a_second_review_as_undecided(bench: Bench) -> None:
    id_ = bench.register(
        bench.scan("a"), decision="unsure", needs_second=True, reviewer_count=1, sole_reviewer_id=bench.rob
    )
    with bench.database.reading() as session:
        row = get_registration(session, id_)
        assert not is_hidden(row, bench.rob) and is_hidden(row, bench.eve)
    assert bench.queue("flagged", reader=bench.rob) == [id_]
    assert bench.queue("flagged", reader=bench.eve) == []


def test_counts_are_those_of_the_queues(bench: Bench) -> None:
    bench.register(bench.scan("a"))
    bench.register(bench.scan("b"), verdict="bad")
    bench.register(bench.scan("c"), decision="accept", reviewer_count=1, sole_reviewer_id=bench.eve)
    with bench.database.reading() as session:
        counts = count_registrations(session, RegistrationFilter(), bench.rob).model_dump()
    for queue in ("flagged", "undecided", "all"):
        assert counts[queue] == len(bench.queue(queue)), queue


def test_of_a_scan_in_another_size_no_registration_counts(bench: Bench) -> None:
    scan = bench.scan("a")
    id_ = bench.register(scan)
    with bench.database.writing() as session:
        row = session.get_one(ScanRow, scan)
        row.metres_per_unit = 0.001
        settle_current(session, row)
    with bench.database.reading() as session:
        row = get_registration(session, id_)
        assert row.is_outdated and not row.is_current
        assert find_newest(session, [scan]) == {}


def test_what_is_not_there_is_named(bench: Bench) -> None:
    nobody = uuid.uuid4()
    with bench.database.reading() as session, pytest.raises(NotFoundError, match=str(nobody)):
        get_registration(session, nobody)
