"""A frame is as bad as its worst hand, whichever that is."""

from __future__ import annotations

from itertools import permutations, product

import numpy as np
import pytest

from tracker.fitting.attempt import Attempt
from tracker.fitting.frame_fit import Fit
from tracker.fitting.object_quality import ObjectQuality
from tracker.fitting.quality import Quality
from tracker.tracking.frame_result import STATUSES, FrameResult, sum_up, tell_statuses

GOOD = Quality(0.002, 0.9, 0.9, 0.9, 0.8, 0.9, 0.0, 0.0, 4e-3)


@pytest.mark.parametrize("hands", list(product(STATUSES, repeat=3)))
def test_the_order_of_hands_does_not_matter_and_one_more_that_is_well_changes_nothing(hands):
    assert {sum_up(each) for each in permutations(hands)} == {sum_up(hands)}
    assert sum_up((*hands, "ok")) == sum_up(hands)
    assert sum_up((*hands, "lost")) == "lost"
    assert sum_up(hands) in hands


def test_a_frame_without_hands_is_well():
    assert sum_up(()) == "ok"


def test_each_hand_has_its_own_status_and_one_that_was_found_and_is_not_to_be_believed_is_lost():
    assert tell_statuses((0, 2, 3), {2}, (3,)) == ("ok", "lost", "recovered")
    assert tell_statuses((3, 2, 0), {2}, (3,)) == ("recovered", "lost", "ok")
    assert tell_statuses((0,), (0,), (0,)) == ("lost",)
    assert tell_statuses((), (0,), (0,)) == ()


def attempt(qualities: dict[int, Quality], objects: dict[int, ObjectQuality]) -> Attempt:
    return Attempt(np.zeros(6), qualities, Fit(np.zeros(6), ({"term": 1.0},), {}), objects)


def test_a_frame_tells_the_quality_of_its_worst_hand_and_none_where_there_is_none():
    bad = Quality(0.02, 0.1, 0.1, 0.1, 0.1, 0.1, 0.0, 0.0, 0.0)
    of_both = FrameResult.of(3, np.zeros(6), ("ok", "lost"), 0.1, attempt({0: GOOD, 1: bad}, {}), {}, [])
    assert of_both.quality is bad and of_both.status == "lost" and of_both.costs == ({"term": 1.0},)
    only_things = attempt({}, {0: ObjectQuality.of_nothing()})
    for nobody in (None, only_things):
        result = FrameResult.of(3, np.zeros(6), (), 0.1, nobody, {}, [])
        assert result.quality is None and result.status == "ok"
        assert result.seen.shape == (0, 0, 21, 2)
