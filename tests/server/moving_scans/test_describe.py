"""Moving scans with what else is known of them: frames that cannot be used, registrations, what is accepted."""

from __future__ import annotations

from server.access.models import LOCAL_ACCOUNT_ID
from server.moving_scans.describe import describe_moving_scans
from tests.server.moving_scans.bench import Bench, add_scan, bench

__all__ = ["bench"]


def test_each_is_told_with_its_own_problems_and_what_came_of_it(bench: Bench) -> None:
    bench.damage(6)
    bench.damage(7)
    bench.decide(0, "accept", 0, 2)
    bench.scan.created_by = LOCAL_ACCOUNT_ID
    other = Bench(bench.session)
    first, second = describe_moving_scans(bench.session, [bench.scan, other.scan])
    assert [(one.frame, one.name, one.detail) for one in first.problems] == [
        (6, "frame6.ply", "it holds no points"),
        (7, "frame7.ply", "it holds no points"),
    ]
    assert (first.point_count, first.registration_count, first.accepted_count) == (107, 2, 3)
    assert first.created_by_name
    assert (second.problems, second.registration_count, second.accepted_count, second.created_by_name) == (
        *([], 2, 0, None),
    )


def test_a_scan_that_nobody_registered_has_none(bench: Bench) -> None:
    lone = add_scan(bench.session)
    told, other = describe_moving_scans(bench.session, [lone, bench.scan])
    assert (told.registration_count, told.accepted_count, other.registration_count) == (0, 0, 2)
    assert describe_moving_scans(bench.session, []) == []
