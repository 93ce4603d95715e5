"""A comparison of labels adds up what became of every hand, and lists no more than a page holds."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from server.exchange.comparison import HandChange
from server.exchange.describe import MAX_LISTED, describe_comparison

JOINTS = st.lists(st.sampled_from(["wrist", "thumb_tip", "index_tip"]), unique=True)
CHANGES = st.lists(
    st.builds(
        HandChange,
        st.integers(0, 9),
        st.just("cam0"),
        st.sampled_from(["right", "left"]),
        st.sampled_from(["added", "removed", "changed"]),
        JOINTS,
        JOINTS,
        st.dictionaries(st.sampled_from(["wrist", "thumb_tip"]), st.floats(0.1, 100.0)),
        JOINTS,
    ),
    max_size=6,
)


@given(CHANGES)
def test_hands_and_joints_are_counted_by_what_became_of_them(changes: list[HandChange]) -> None:
    found = describe_comparison(changes)
    assert found.hands_added + found.hands_removed + found.hands_changed == len(changes) == len(found.items)
    assert found.joints_added == sum(len(change.joints_added) for change in changes)
    assert found.joints_removed == sum(len(change.joints_removed) for change in changes)
    assert found.joints_restated == sum(len(change.joints_restated) for change in changes)
    shifts = [shift for change in changes for shift in change.joints_moved.values()]
    assert found.joints_moved == len(shifts) and not found.is_cut
    if shifts:
        assert found.max_shift_px == max(shifts) and found.mean_shift_px == pytest.approx(sum(shifts) / len(shifts))
    else:
        assert found.max_shift_px is None and found.mean_shift_px is None


def test_a_long_list_is_cut_and_says_so_but_counts_everything() -> None:
    changes = [HandChange(frame, "cam0", "right", "added", ["wrist"]) for frame in range(MAX_LISTED + 1)]
    found = describe_comparison(changes)
    assert found.is_cut and len(found.items) == MAX_LISTED and found.joints_added == MAX_LISTED + 1
