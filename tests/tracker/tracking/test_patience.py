"""Searches in vain grow rarer; one that finds something starts anew."""

from __future__ import annotations

from tracker.tracking.patience import Patience


def test_the_wait_doubles_with_each_search_in_vain_up_to_the_longest():
    patience, waits = Patience(), []
    for _ in range(6):
        assert patience.is_over
        patience = patience.after_search(False, 4, 20)
        waits.append(patience.wait)
        for _ in range(patience.wait):
            assert not patience.is_over
            patience = patience.pass_frame()
    assert waits == [4, 8, 16, 20, 20, 20]


def test_after_a_find_nobody_waits():
    assert Patience(0, 64).after_search(True, 4, 64) == Patience()
