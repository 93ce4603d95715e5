"""Which registration of a frame counts, taken together to stretches, and counted for a list of moving scans."""

from __future__ import annotations

import uuid

from server.moving_scans.accepted import (
    count_accepted,
    describe_stretches,
    find_accepted,
    find_last,
    number_registrations,
)
from server.moving_scans.decisions import find_standing, list_decisions
from tests.server.moving_scans.bench import Bench, bench

__all__ = ["bench"]


def test_the_last_decision_about_each_frame_of_one_registration_is_found(bench: Bench) -> None:
    whole, _ = bench.decide(0, "accept", 0, 7)
    bench.decide(1, "reject", 4, 7)
    part, _ = bench.decide(0, "reject", 2, 3)
    standing = find_standing(list_decisions(bench.session, bench.scan.id))
    last = find_last(standing, bench.registrations[0].id)
    assert {frame: row.id for frame, row in last.items()} == {
        frame: (part if frame in (2, 3) else whole).id for frame in range(8)
    }
    assert find_last(standing, uuid.uuid4()) == {}


def test_an_accepted_frame_says_which_file_it_is_and_who_accepted_it(bench: Bench) -> None:
    decision, _ = bench.decide(1, "accept", 4, 5)
    first, second = find_accepted(bench.session, bench.scan.id)
    assert (first.frame, second.frame) == (4, 5)
    assert (first.registration_id, first.decision_id) == (bench.registrations[1].id, decision.id)
    assert first.digest == f"{4:064d}" and first.frame_registration_id != second.frame_registration_id


def test_a_stretch_is_accepted_where_its_registration_has_frames(bench: Bench) -> None:
    """The second registration has no frame 3."""
    bench.decide(1, "accept", 1, 5)
    assert list(bench.accepted()) == [1, 2, 4, 5]
    [stretch] = describe_stretches(bench.session, find_accepted(bench.session, bench.scan.id))
    assert (stretch.first_frame, stretch.last_frame, stretch.frame_count) == (1, 5, 4)


def test_moving_scans_nobody_decided_about_are_not_counted(bench: Bench) -> None:
    other = Bench(bench.session)
    assert count_accepted(bench.session, [bench.scan.id, other.scan.id]) == {}
    bench.decide(0, "accept", 0, 2)
    other.decide(0, "reject", 0, 2)
    assert count_accepted(bench.session, [bench.scan.id, other.scan.id]) == {bench.scan.id: 3, other.scan.id: 0}
    assert (
        count_accepted(bench.session, [other.scan.id]) == {other.scan.id: 0} and count_accepted(bench.session, []) == {}
    )


def test_registrations_are_numbered_for_each_moving_scan_by_itself(bench: Bench) -> None:
    other = Bench(bench.session)
    numbers = number_registrations(bench.session, {bench.scan.id, other.scan.id})
    for each in (bench, other):
        assert sorted(numbers[row.id] for row in each.registrations) == [1, 2]
    assert number_registrations(bench.session, set()) == {}


def test_no_frames_make_no_stretch(bench: Bench) -> None:
    assert describe_stretches(bench.session, []) == []


def test_stretches_are_frames_in_a_row_of_one_registration_and_one_decision(bench: Bench) -> None:
    bench.decide(0, "accept", 0, 7)
    bench.decide(1, "accept", 4, 6)
    stretches = describe_stretches(bench.session, find_accepted(bench.session, bench.scan.id))
    assert [(each.first_frame, each.last_frame, each.frame_count) for each in stretches] == [
        (0, 3, 4),
        (4, 6, 3),
        (7, 7, 1),
    ]
    numbers = number_registrations(bench.session, {bench.scan.id})
    assert sorted(numbers.values()) == [1, 2]
    assert [each.registration_number for each in stretches] == [
        numbers[bench.registrations[which].id] for which in (0, 1, 0)
    ]
