"""What counts of a moving scan is what a plain look at all decisions, one after the other, says."""

from __future__ import annotations

import uuid

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sqlalchemy import func, select

from server.access.models import LOCAL_ACCOUNT_ID
from server.errors import ConflictError, InvalidError, NotFoundError
from server.moving_scans.adding import order_naturally
from server.moving_scans.decisions import find_standing, list_decisions, undo
from server.moving_scans.models import StretchDecisionRow
from tests.server.moving_scans.bench import FRAMES, Bench, bench

__all__ = ["bench"]


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
