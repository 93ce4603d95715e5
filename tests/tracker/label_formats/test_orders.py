"""Others list the same 21 joints in their own order and by their own names; the way there and back loses none."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracker.errors import AnnotationError
from tracker.label_formats.orders import JOINT_ORDERS, find_joint, from_order, read_names, to_order
from tracker.model.joints import FINGERS, HAND_JOINTS

ORDERS = sorted(JOINT_ORDERS)


@pytest.mark.parametrize("order", ORDERS)
def test_an_order_is_the_21_joints_each_once_and_there_and_back_is_nothing(order) -> None:
    assert sorted(JOINT_ORDERS[order]) == sorted(HAND_JOINTS)
    values = np.random.default_rng(0).random((21, 3))
    assert np.array_equal(from_order(to_order(values, order), order), values)
    assert np.array_equal(to_order(from_order(values, order), order), values)
    assert [HAND_JOINTS[int(place)] for place in to_order(np.arange(21.0), order)] == list(JOINT_ORDERS[order])


def test_published_orders_are_as_published() -> None:
    assert JOINT_ORDERS["mediapipe"][4:9] == ("thumb_tip", "index_mcp", "index_pip", "index_dip", "index_tip")
    assert JOINT_ORDERS["mano"][13:] == ("thumb_cmc", "thumb_mcp", "thumb_ip", *(f"{f}_tip" for f in FINGERS))
    assert JOINT_ORDERS["mano"][7:13] == tuple(f"{f}_{p}" for f in ("little", "ring") for p in ("mcp", "pip", "dip"))
    assert JOINT_ORDERS["interhand"][:5] == ("thumb_tip", "thumb_ip", "thumb_mcp", "thumb_cmc", "index_tip")
    assert JOINT_ORDERS["interhand"][20] == "wrist"


@pytest.mark.parametrize("joint", HAND_JOINTS)
def test_a_joint_is_known_by_any_of_its_usual_names(joint) -> None:
    finger, _, part = joint.partition("_")
    number = {"wrist": "", "cmc": 1, "mcp": 2 if finger == "thumb" else 1, "pip": 2, "ip": 3, "dip": 3, "tip": 4}
    names = [joint, joint.upper(), f"Right Hand {joint}", f"left-{joint.replace('_', '-')}", f"L {joint}"]
    if part:
        names += [f"{finger}_finger_{part}", f"{finger}{number[part]}", f"{finger.title()} {number[part]}"]
        other = {"little": ("pinky", "small", "pinkie"), "index": ("forefinger",)}.get(finger, ())
        names += [f"{word}_{part}" for word in other]
    assert {find_joint(name) for name in names} == {HAND_JOINTS.index(joint)}


@given(st.text(max_size=30))
def test_any_other_word_is_no_joint_or_exactly_one(text) -> None:
    assert find_joint(text) in (None, *range(21))


@given(st.permutations(HAND_JOINTS))
def test_names_in_any_order_are_read_as_their_places(names) -> None:
    assert [HAND_JOINTS[place] for place in read_names(names, "file")] == list(names)


@pytest.mark.parametrize(
    "names",
    [HAND_JOINTS[:20], (*HAND_JOINTS[:20], "nose"), (*HAND_JOINTS, "wrist"), (*HAND_JOINTS[:20], "wrist"), ()],
    ids=["too few", "a stranger", "too many", "one twice", "none"],
)
def test_what_is_not_the_21_joints_of_a_hand_is_refused_with_what_is_missing(names) -> None:
    with pytest.raises(AnnotationError, match=r"set\.csv: needed the 21 joints of a hand"):
        read_names(names, "set.csv")
