"""The hands of one image: named together, written as labels, looked for in as few turns as will do."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import permutations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tracker.capture.annotations import OCCLUDED, VISIBLE
from tracker.capture.frame import Frame
from tracker.detection.image_hands import DETECTOR_LABEL, SOURCE, ImageHand, name_hands
from tracker.landmarks import DetectedHand

FRAME = Frame(7, "cam1", np.zeros((100, 120, 3), np.uint8), None)


def detected(points: np.ndarray | None = None, presence: float = 0.9, right: float = 0.8) -> DetectedHand:
    points = np.random.default_rng(0).uniform(20.0, 80.0, (21, 2)) if points is None else points
    return DetectedHand(points, np.zeros((21, 3)), presence, right)


def test_a_hand_s_score_is_that_there_is_one() -> None:
    assert ImageHand("right", detected(presence=0.37), np.zeros(21, bool)).score == 0.37


def test_labels_go_to_the_ends_of_the_fingers_and_tell_hidden_joints() -> None:
    is_hidden = np.arange(21) % 4 == 0
    hand = ImageHand("left", detected(), is_hidden)
    label = hand.annotate(FRAME)
    assert label.key == (7, "cam1", "left")
    np.testing.assert_allclose(label.points[:, :2], hand.detected.with_finger_ends().points, atol=0.005 + 1e-9)
    np.testing.assert_array_equal(label.points[:, 2], np.where(is_hidden, OCCLUDED, VISIBLE))
    assert label.sources == (SOURCE,) * 21 and SOURCE.kind == "detector" and SOURCE.label == DETECTOR_LABEL
    np.testing.assert_array_equal(label.points, np.round(label.points, 2))


@pytest.mark.parametrize(
    ("x", "y", "is_inside"),
    [
        (-0.5, 50.0, True),
        (-0.51, 50.0, False),
        (119.49, 50.0, True),
        (119.5, 50.0, False),
        (50.0, -0.5, True),
        (50.0, -0.51, False),
        (50.0, 99.49, True),
        (50.0, 99.5, False),
    ],
)
def test_joints_outside_of_the_image_are_left_open(x: float, y: float, is_inside: bool) -> None:
    points = np.full((21, 2), 50.0)
    points[9] = x, y
    label = ImageHand("right", detected(points), np.zeros(21, bool)).annotate(FRAME)
    assert label.sources is not None
    assert (label.points[9].tolist() == [0.0, 0.0, 0.0]) != is_inside
    assert (label.sources[9] == SOURCE) == is_inside
    assert sum(source is None for source in label.sources) == (0 if is_inside else 1)


@settings(max_examples=30)
@given(st.lists(st.floats(0.0, 1.0), min_size=2, max_size=2))
def test_of_two_hands_the_one_that_is_more_a_right_one_is_the_right_one(rights: Sequence[float]) -> None:
    hands = [detected(right=right) for right in rights]
    named = name_hands(hands, ("right", "left"))
    assert {id(hand) for hand in named.values()} == {id(hand) for hand in hands}
    right, left = (np.clip(named[name].right, 1e-6, 1.0 - 1e-6) for name in ("right", "left"))
    assert right >= left - 1e-9


def test_the_order_in_which_hands_are_found_or_named_changes_nothing() -> None:
    hands = [detected(right=0.9), detected(right=0.3)]
    for found in permutations(hands):
        for names in (("right", "left"), ("left", "right")):
            assert name_hands(found, names) == {"right": hands[0], "left": hands[1]}


@pytest.mark.parametrize("name", ["right", "left"])
def test_the_only_hand_of_a_recording_is_the_one_that_was_found_first_whatever_it_looks_like(name: str) -> None:
    hands = [detected(right=0.0), detected(right=1.0)]
    assert name_hands(hands, (name,)) == {name: hands[0]}
    assert name_hands([], (name,)) == {}
