"""Registrations of moving scans: found with their frames and ancestors, and told with how far and how good they are."""

from __future__ import annotations

import uuid

import pytest

from server.errors import NotFoundError
from server.moving_scans.models import FrameRegistrationRow
from server.moving_scans.registrations import (
    describe_registrations,
    find_before,
    find_frame,
    get_frame,
    get_registration,
    list_frames,
    list_registrations,
)
from tests.server.moving_scans.bench import FRAMES, Bench, bench

__all__ = ["bench"]


def change(bench: Bench, which: int, frame: int, **columns: object) -> None:
    row = get_frame(bench.session, bench.registrations[which].id, frame)
    for name, value in columns.items():
        setattr(row, name, value)
    bench.session.flush()


def test_a_registration_and_a_frame_that_are_not_there_are_named(bench: Bench) -> None:
    second, unknown = bench.registrations[1], uuid.uuid4()
    assert get_registration(bench.session, second.id) is second
    with pytest.raises(NotFoundError, match=f"There is no registration {unknown} of a moving scan"):
        get_registration(bench.session, unknown)
    assert find_frame(bench.session, second.id, 3) is None
    with pytest.raises(NotFoundError, match=f"The registration {second.id} has no frame 3, or not yet"):
        get_frame(bench.session, second.id, 3)


def test_those_of_a_moving_scan_come_newest_first_and_none_of_another(bench: Bench) -> None:
    other = Bench(bench.session)
    assert [row.id for row in list_registrations(bench.session, bench.scan.id)] == [
        row.id for row in sorted(bench.registrations, key=lambda row: (row.created_at, row.id), reverse=True)
    ]
    assert {row.id for row in list_registrations(bench.session, other.scan.id)} == {
        row.id for row in other.registrations
    }


def test_the_frame_before_is_the_nearest_of_the_parent_else_of_its_own_ancestors(bench: Bench) -> None:
    first, second = bench.registrations
    second.parent_id = first.id
    third = bench.register([6], parent_id=second.id)

    def before(parent: uuid.UUID | None, frame: int) -> tuple[uuid.UUID, int] | None:
        found: FrameRegistrationRow | None = find_before(bench.session, parent, frame)
        return None if found is None else (found.registration_id, found.frame)

    assert before(second.id, 4) == (second.id, 2), "it has no frame 3"
    assert before(second.id, 1) == (first.id, 0), "it begins at 1"
    assert before(third.id, 3) == (second.id, 2) and before(third.id, 7) == (third.id, 6)
    assert before(first.id, 0) is None and before(None, 5) is None


def test_each_frame_tells_its_verdict_which_hands_are_guessed_and_what_was_decided(bench: Bench) -> None:
    change(bench, 1, 2, verdict="doubtful", reasons=["the left hand is missing"], has_left=False)
    change(bench, 1, 4, has_left=False, has_right=False)
    bench.decide(1, "accept", 1, 2)
    bench.decide(1, "reject", 2, 2)
    bench.decide(0, "accept", 5, 5)
    frames = {each.frame: each for each in list_frames(bench.session, bench.registrations[1])}
    assert list(frames) == [1, 2, 4, 5, 6, 7]
    assert (frames[2].verdict, frames[2].reasons, frames[2].mean_mm) == (
        *("doubtful", ["the left hand is missing"], 3.0),
    )
    assert [frames[frame].guessed for frame in (1, 2, 4)] == [[], ["left"], ["left", "right"]]
    assert [frames[frame].decision for frame in (1, 2, 5)] == ["accept", "reject", None]


def test_a_registration_is_told_by_what_its_frames_come_to(bench: Bench) -> None:
    change(bench, 1, 2, verdict="bad", has_left=False, scan_to_mesh_mm={"mean": None, "p95": None})
    bench.decide(1, "accept", 4, 7)
    bench.decide(1, "reject", 7, 7)
    [told] = describe_registrations(bench.session, [bench.registrations[1]])
    assert (told.frames_done, told.verdicts, told.guessed) == (6, {"good": 5, "bad": 1}, {"left": 1})
    means = [1.0 + frame for frame in (1, 4, 5, 6, 7)]
    assert told.scan_to_mesh_mm == pytest.approx(sum(means) / len(means)), "what was not measured counts nowhere"
    assert (told.accepted_count, told.rejected_count, told.created_by_name) == (3, 1, None)


def test_one_that_has_just_begun_has_nothing_yet(bench: Bench) -> None:
    row = bench.register([0])
    bench.session.delete(get_frame(bench.session, row.id, 0))
    bench.session.flush()
    [told] = describe_registrations(bench.session, [row])
    assert (told.frames_done, told.verdicts, told.scan_to_mesh_mm) == (0, {}, None)
    assert (told.number, told.first_frame, told.last_frame) == (3, 0, FRAMES - 1)
    assert describe_registrations(bench.session, []) == []
