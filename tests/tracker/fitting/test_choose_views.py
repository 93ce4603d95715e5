"""Of many views half look in each frame, and each looks in every other one."""

from __future__ import annotations

import pytest

from tracker.fitting.choose_views import PLENTY, choose_views


@pytest.mark.parametrize("count", range(PLENTY))
def test_of_a_few_views_all_look(count):
    assert [list(choose_views(count, frame)) for frame in (7, 8)] == [list(range(count))] * 2


@pytest.mark.parametrize("count", range(PLENTY, 17))
def test_of_many_views_two_frames_have_all_once_and_each_frame_three_or_more(count):
    one, next_one = choose_views(count, 7), choose_views(count, 8)
    assert sorted([*one, *next_one]) == list(range(count))
    assert min(len(one), len(next_one)) >= 3
