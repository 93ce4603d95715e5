"""The 21 joints of a hand and the lines between them."""

from __future__ import annotations

import pytest

from tracker.model.joints import FINGERS, HAND_EDGES, HAND_JOINTS, SIDES


def test_joints_are_the_wrist_and_four_to_each_finger_from_the_thumb_outwards() -> None:
    assert len(HAND_JOINTS) == len(set(HAND_JOINTS)) == 21
    assert HAND_JOINTS[0] == "wrist"
    for number, finger in enumerate(FINGERS):
        own = HAND_JOINTS[1 + 4 * number : 5 + 4 * number]
        ends = ("cmc", "mcp", "ip", "tip") if finger == "thumb" else ("mcp", "pip", "dip", "tip")
        assert own == tuple(f"{finger}_{end}" for end in ends)


def test_lines_make_one_tree_that_never_leaves_a_finger_but_at_the_wrist() -> None:
    assert len(HAND_EDGES) == 20
    assert sorted(end for _, end in HAND_EDGES) == list(range(1, 21)), "each joint hangs on just one"
    for start, end in HAND_EDGES:
        assert start < end
        before, name = HAND_JOINTS[start], HAND_JOINTS[end]
        if before == "wrist":
            assert name in {"thumb_cmc", "index_mcp", "middle_mcp", "ring_mcp", "little_mcp"}
        else:
            assert before.split("_")[0] == name.split("_")[0]


@pytest.mark.parametrize("names", [FINGERS, SIDES])
def test_names_are_words_in_small_letters_that_occur_once(names) -> None:
    assert len(set(names)) == len(names) and all(name.isalpha() and name.islower() for name in names)
