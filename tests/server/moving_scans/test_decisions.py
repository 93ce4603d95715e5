"""What counts of a moving scan is what a plain look at all decisions, one after the other, says."""

from __future__ import annotations

import uuid
from collections.abc import Iterator

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sqlalchemy import func, select
from sqlalchemy.orm import Session

from server.access.models import LOCAL_ACCOUNT_ID
from server.errors import ConflictError, InvalidError, NotFoundError
from server.moving_scans.accepted import describe_stretches, find_accepted, number_registrations
from server.moving_scans.adding import order_naturally
from server.moving_scans.body_sets import create_body_set, get_body_set, read_members
from server.moving_scans.decision_schemas import BodySetMake, StretchDecisionMake
from server.moving_scans.decisions import decide, find_standing, list_decisions, undo
from server.moving_scans.models import FrameRegistrationRow, MovingRegistrationRow, MovingScanRow, StretchDecisionRow
from server.moving_scans.storing import name_frame
from tests.server.conftest import Studio

FRAMES = 8


class Bench:
    """A moving scan of eight frames with two registrations; the second lacks frames 0 and 3."""

    def __init__(self, session: Session) -> None:
        self.session = session
        self.scan = MovingScanRow(
            name="Ada waves",
            subject="Ada",
            fps=30.0,
            frames=[],
            frame_count=FRAMES,
            usable_count=FRAMES,
            digest="d" * 64,
            byte_count=1,
            metres_per_unit=1.0,
            is_unit_guessed=False,
            box_m=[],
            notes=[],
        )
        session.add(self.scan)
        session.flush()
        self.registrations = [self._register(range(FRAMES)), self._register([1, 2, 4, 5, 6, 7])]

    def _register(self, frames) -> MovingRegistrationRow:
        row = MovingRegistrationRow(
            id=(id_ := uuid.uuid4()),
            moving_scan_id=self.scan.id,
            job_id=uuid.uuid4(),
            template_id=id_,
            prior="mixture",
            holds_hands=True,
            has_velocity=True,
            population="neutral",
            first_frame=min(frames),
            last_frame=FRAMES - 1,
        )
        self.session.add(row)
        self.session.flush()
        self.session.add_all(
            FrameRegistrationRow(
                id=name_frame(id_, frame),
                registration_id=id_,
                frame=frame,
                digest=f"{frame:064d}",
                verdict="good",
                reasons=[],
                scan_to_mesh_mm={},
                has_left=True,
                has_right=True,
                seconds=1.0,
            )
            for frame in frames
        )
        self.session.flush()
        return row

    def decide(self, which: int, decision: str, first: int, last: int, operation: uuid.UUID | None = None):
        made = StretchDecisionMake(
            decision=decision,  # type: ignore[arg-type]
            first_frame=first,
            last_frame=last,
            operation_id=operation or uuid.uuid4(),
        )
        return decide(self.session, self.registrations[which], LOCAL_ACCOUNT_ID, made)

    def accepted(self) -> dict[int, int]:
        """Frame to the number of the registration that counts."""
        ids = [row.id for row in self.registrations]
        return {each.frame: ids.index(each.registration_id) for each in find_accepted(self.session, self.scan.id)}


@pytest.fixture
def bench(studio: Studio) -> Iterator[Bench]:
    with studio.database.writing() as session:
        yield Bench(session)
        session.rollback()


@pytest.mark.parametrize("seed", range(6))
def test_the_last_standing_decision_about_a_frame_counts_as_a_plain_look_says(bench: Bench, seed: int) -> None:
    rng = np.random.default_rng(seed)
    told: list[tuple[int, str, int, int]] = []
    made: list[StretchDecisionRow] = []
    stands: list[bool] = []
    for _ in range(14):
        if made and rng.random() < 0.3 and any(stands):
            back = int(rng.choice(np.flatnonzero(stands)))
            undo(bench.session, made[back].id, LOCAL_ACCOUNT_ID, uuid.uuid4())
            stands[back] = False
            continue
        which, decision = int(rng.integers(2)), str(rng.choice(["accept", "reject"]))
        first, last = sorted(int(number) for number in rng.integers(1 if which else 0, FRAMES, 2))
        if which and {*range(first, last + 1)} <= {3}:
            continue
        row, is_new = bench.decide(which, decision, first, last)
        assert is_new
        made.append(row)
        told.append((which, decision, first, last))
        stands.append(True)
    expected: dict[int, int] = {}
    for frame in range(FRAMES):
        last: dict[int, tuple[int, str]] = {}
        for number, (which, decision, first, end) in enumerate(told):
            if stands[number] and first <= frame <= end and not (which and frame in (0, 3)):
                last[which] = number, decision
        counting = [(number, which) for which, (number, decision) in last.items() if decision == "accept"]
        if counting:
            expected[frame] = max(counting)[1]
    assert bench.accepted() == expected
    assert [row.id for row in find_standing(list_decisions(bench.session, bench.scan.id))] == [
        row.id for row, stands_now in zip(made, stands, strict=True) if stands_now
    ]


def test_an_undo_brings_back_what_stood_before_and_cannot_be_undone(bench: Bench) -> None:
    bench.decide(0, "accept", 0, 7)
    rejected, _ = bench.decide(0, "reject", 2, 4)
    assert bench.accepted() == dict.fromkeys((0, 1, 5, 6, 7), 0)
    taken, _ = undo(bench.session, rejected.id, LOCAL_ACCOUNT_ID, uuid.uuid4())
    assert bench.accepted() == dict.fromkeys(range(FRAMES), 0)
    with pytest.raises(ConflictError, match="undo already"):
        undo(bench.session, taken.id, LOCAL_ACCOUNT_ID, uuid.uuid4())
    with pytest.raises(ConflictError, match="already undone"):
        undo(bench.session, rejected.id, LOCAL_ACCOUNT_ID, uuid.uuid4())
    with pytest.raises(NotFoundError, match="There is no decision"):
        undo(bench.session, uuid.uuid4(), LOCAL_ACCOUNT_ID, uuid.uuid4())


def test_the_same_operation_is_done_once_and_another_one_under_its_name_is_refused(bench: Bench) -> None:
    operation = uuid.uuid4()
    first, is_new = bench.decide(0, "accept", 1, 2, operation)
    again, is_new_again = bench.decide(0, "accept", 1, 2, operation)
    assert is_new and not is_new_again and again.id == first.id
    for which, decision, last in ((0, "reject", 2), (0, "accept", 3), (1, "accept", 2)):
        with pytest.raises(InvalidError, match="Make a new operation_id"):
            bench.decide(which, decision, 1, last, operation)
    assert bench.session.scalar(select(func.count()).select_from(StretchDecisionRow)) == 1


@pytest.mark.parametrize(("which", "first", "last"), [(0, 0, 8), (1, 0, 2), (1, 3, 3)])
def test_frames_that_are_not_registered_cannot_be_decided_about(bench: Bench, which, first, last) -> None:
    with pytest.raises(InvalidError, match="Choose"):
        bench.decide(which, "accept", first, last)
    assert bench.accepted() == {}


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


@given(st.lists(st.integers(0, 10**9), min_size=1, max_size=12, unique=True), st.sampled_from(["frame", "a/b-", ""]))
def test_files_are_ordered_by_their_numbers_with_leading_zeros_or_without(numbers, prefix) -> None:
    names = [f"{prefix}{number}.ply" for number in numbers]
    assert sorted(names, key=order_naturally) == [f"{prefix}{number}.ply" for number in sorted(numbers)]
    padded = [f"{prefix}{number:010d}.PLY" for number in numbers]
    assert sorted(padded, key=order_naturally) == sorted(padded)


@given(st.lists(st.text(max_size=20), max_size=8))
def test_any_names_have_an_order(names) -> None:
    keys = [order_naturally(name) for name in sorted(names, key=order_naturally)]
    assert keys == sorted(keys) and len(keys) == len(names)
