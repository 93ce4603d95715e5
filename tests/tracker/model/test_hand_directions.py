"""Directions in which one hand differs from another add up, for vertices, joints and marks alike."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tracker.grips import ball
from tracker.model.default_hand import default_hand
from tracker.model.hand_directions import HandDirections
from tracker.model.local_directions import local_directions, mark_directions
from tracker.model.scene import Scene
from tracker.model.shape import with_shape


@pytest.fixture(scope="module")
def hand():
    return default_hand("right")


@pytest.fixture(scope="module")
def every(hand) -> HandDirections:
    """Of the shape basis, of single bones and of marks."""
    marks = mark_directions(hand, np.full(21, 0.004), np.full(21, 0.002))
    return HandDirections.join([HandDirections.of_shape(hand), local_directions(hand), marks])


def landmarks_of(model) -> np.ndarray:
    return Scene((model,)).pose_at(np.zeros(model.num_dofs)).landmarks(0)


def test_a_shape_basis_as_directions_is_the_shape_of_the_model(hand, rng) -> None:
    directions = HandDirections.of_shape(hand)
    assert hand.shape is not None and directions.names == hand.shape.names
    values = 0.5 * rng.normal(size=len(directions.names))
    moved, shaped = directions.apply(hand, values), with_shape(hand, values)
    np.testing.assert_allclose(moved.vertices, shaped.vertices, atol=1e-12)
    np.testing.assert_allclose(moved.skeleton.joints_rest, shaped.skeleton.joints_rest, atol=1e-12)
    assert not directions.marks.any()


def test_what_has_no_shape_basis_says_whose_it_is() -> None:
    with pytest.raises(AssertionError, match="ball has no shape basis"):
        HandDirections.of_shape(ball())


def test_landmarks_move_as_the_directions_of_landmarks_say(hand, every, rng) -> None:
    values = rng.normal(size=len(every.names))
    expected = landmarks_of(hand) + np.einsum("s,sjx->jx", values, every.of_landmarks(hand))
    np.testing.assert_allclose(landmarks_of(every.apply(hand, values)), expected, atol=1e-9)


def test_steps_one_after_the_other_are_their_sum_and_the_model_given_stays(hand, every, rng) -> None:
    one, two = rng.normal(size=(2, len(every.names)))
    before = hand.vertices.copy()
    after, at_once = every.apply(every.apply(hand, one), two), every.apply(hand, one + two)
    np.testing.assert_allclose(after.vertices, at_once.vertices, atol=1e-12)
    np.testing.assert_allclose(after.skeleton.joints_rest, at_once.skeleton.joints_rest, atol=1e-12)
    np.testing.assert_allclose(after.hand.joint_offsets, at_once.hand.joint_offsets, atol=1e-12)
    assert after.shape is hand.shape
    np.testing.assert_array_equal(hand.vertices, before)
    np.testing.assert_array_equal(every.apply(hand, np.zeros(len(every.names))).vertices, before)


def test_joined_directions_stand_in_the_order_of_their_parts(hand, every) -> None:
    parts = [HandDirections.of_shape(hand), local_directions(hand)]
    count = sum(len(part.names) for part in parts)
    assert every.names[:count] == (*parts[0].names, *parts[1].names)
    np.testing.assert_array_equal(every.vertices[len(parts[0].names) : count], parts[1].vertices)
    np.testing.assert_array_equal(every.joints[:count], np.concatenate([part.joints for part in parts]))


def test_a_value_too_few_or_an_offset_too_many_is_refused(hand, every) -> None:
    with pytest.raises(AssertionError):
        every.apply(hand, np.zeros(len(every.names) - 1))
    with pytest.raises(AssertionError):
        HandDirections(every.names, every.vertices, every.joints[1:], every.marks)
