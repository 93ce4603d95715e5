"""Sets of accepted frames: kept once, never changed, listed with where each frame comes from."""

from __future__ import annotations

import uuid

import pytest
from sqlalchemy import select

from server.access.audit import AuditRow
from server.access.models import LOCAL_ACCOUNT_ID
from server.errors import InvalidError, NotFoundError
from server.moving_scans.body_sets import (
    create_body_set,
    describe_accepted,
    describe_body_sets,
    get_body_set,
    list_body_sets,
    read_members,
)
from server.moving_scans.decision_schemas import BodySetMake
from server.moving_scans.models import BodySetRow
from tests.server.moving_scans.bench import Bench, bench

__all__ = ["bench"]


def keep(bench: Bench, name: str) -> BodySetRow:
    made = BodySetMake(moving_scan_id=bench.scan.id, name=name)
    return create_body_set(bench.session, bench.scan, made, LOCAL_ACCOUNT_ID)[0]


def test_what_is_accepted_now_is_told_with_its_stretches(bench: Bench) -> None:
    assert describe_accepted(bench.session, bench.scan.id).model_dump() == {"frame_count": 0, "stretches": []}
    bench.decide(0, "accept", 0, 3)
    bench.decide(1, "accept", 2, 2)
    told = describe_accepted(bench.session, bench.scan.id)
    assert told.frame_count == 4
    assert [(each.first_frame, each.last_frame) for each in told.stretches] == [(0, 1), (2, 2), (3, 3)]


def test_other_frames_make_another_set_and_the_same_ones_again_the_one_there_is(bench: Bench) -> None:
    bench.decide(0, "accept", 0, 1)
    first = keep(bench, "first")
    bench.decide(0, "accept", 2, 2)
    second = keep(bench, "second")
    assert (first.frame_count, second.frame_count) == (2, 3) and first.digest != second.digest
    bench.decide(0, "reject", 2, 2)
    assert keep(bench, "third") is first, "the same decisions accept the same frames"
    acts = bench.session.scalars(select(AuditRow.detail).where(AuditRow.act == "body_set.make"))
    assert sorted(detail["frames"] for detail in acts) == [2, 3]


def test_sets_come_newest_first_and_those_of_one_moving_scan_alone_where_asked(bench: Bench) -> None:
    other = Bench(bench.session)
    kept = []
    for each, last in ((bench, 0), (other, 1), (bench, 2)):
        each.decide(0, "accept", 0, last)
        kept.append(keep(each, f"{last}").id)
    page, cursor = list_body_sets(bench.session, None, None, 2)
    rest, end = list_body_sets(bench.session, None, cursor, 2)
    assert ([row.id for row in (*page, *rest)], end) == (kept[::-1], None)
    assert [row.id for row in list_body_sets(bench.session, other.scan.id, None, 9)[0]] == [kept[1]]


def test_a_set_is_described_as_it_was_kept_whatever_was_rejected_since(bench: Bench) -> None:
    bench.decide(0, "accept", 0, 3)
    row = keep(bench, "all")
    bench.decide(0, "reject", 0, 7)
    [told] = describe_body_sets(bench.session, [row])
    assert (told.id, told.name, told.digest, told.frame_count) == (row.id, "all", row.digest, 4)
    assert [(each.first_frame, each.last_frame) for each in told.stretches] == [(0, 3)] and told.created_by_name
    assert describe_body_sets(bench.session, []) == []


def test_a_set_is_kept_once_and_stays_as_it_was_whatever_is_decided_later(bench: Bench) -> None:
    with pytest.raises(InvalidError, match="No frame of “Ada waves” is accepted"):
        create_body_set(
            bench.session, bench.scan, BodySetMake(moving_scan_id=bench.scan.id, name="all"), LOCAL_ACCOUNT_ID
        )
    bench.decide(0, "accept", 2, 4)
    kept, is_new = create_body_set(
        bench.session, bench.scan, BodySetMake(moving_scan_id=bench.scan.id, name="all"), LOCAL_ACCOUNT_ID
    )
    again, is_new_again = create_body_set(
        bench.session, bench.scan, BodySetMake(moving_scan_id=bench.scan.id, name="other"), LOCAL_ACCOUNT_ID
    )
    assert is_new and not is_new_again and again.id == kept.id and kept.frame_count == 3
    bench.decide(0, "reject", 0, 7)
    members = read_members(bench.session, get_body_set(bench.session, kept.id))
    assert [(each.frame, each.digest) for each in members] == [(frame, f"{frame:064d}") for frame in (2, 3, 4)]
    with pytest.raises(NotFoundError, match="no set of accepted frames"):
        get_body_set(bench.session, uuid.uuid4())
