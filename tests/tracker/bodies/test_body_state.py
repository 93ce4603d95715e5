"""A body in few numbers: steps compose as turns do, and hands say the same in either of their two languages."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from tests.tracker.bodies.posed_bodies import MODEL, SPACE, draw_state
from tracker.bodies.body_state import (
    NUM_TURNED,
    hand_space,
    make_state,
    move_body,
    reduce_jacobian,
    with_hands,
)

WIDTH = NUM_TURNED + 2 * SPACE.size + MODEL.num_shape
seeds = st.integers(0, 2**32 - 1)


def fingers_by_turns(fingers: np.ndarray, turns: np.ndarray) -> np.ndarray:
    """(30, 3) after small turns (30, 3) from the left."""
    return (Rotation.from_rotvec(turns) * Rotation.from_rotvec(fingers)).as_rotvec()


@settings(max_examples=15, deadline=None)
@given(seeds)
def test_a_step_of_nothing_changes_nothing(seed: int) -> None:
    state = draw_state(seed)
    moved = move_body(MODEL, SPACE, state, np.zeros(WIDTH))
    for name in ("pose", "shape", "translation", "hands"):
        assert np.allclose(getattr(moved, name), getattr(state, name), atol=1e-12), name


@settings(max_examples=15, deadline=None)
@given(seeds)
def test_a_step_turns_the_joints_from_the_left_and_adds_to_everything_else(seed: int) -> None:
    state, rng = draw_state(seed), np.random.default_rng(seed)
    step = 0.2 * rng.standard_normal(WIDTH)
    moved = move_body(MODEL, SPACE, state, step)
    turns = np.concatenate([step[:3], step[6:NUM_TURNED]]).reshape(-1, 3)
    expected = Rotation.from_rotvec(turns) * Rotation.from_rotvec(state.pose[:22])
    assert (expected.inv() * Rotation.from_rotvec(moved.pose[:22])).magnitude().max() < 1e-9
    assert np.allclose(moved.hands - state.hands, step[NUM_TURNED : NUM_TURNED + 12].reshape(2, 6), atol=1e-12)
    assert np.allclose(moved.shape - state.shape, step[NUM_TURNED + 12 :], atol=1e-12)
    assert np.allclose(moved.pose[22:], SPACE.fingers_of(moved.hands), atol=1e-12), "fingers follow from the hands"


@settings(max_examples=25, deadline=None)
@given(seeds)
def test_turns_of_fingers_by_coefficients_meet_finite_differences(seed: int) -> None:
    hands = 0.6 * np.random.default_rng(seed).standard_normal((2, 6))
    fingers, delta = SPACE.fingers_of(hands), 1e-6
    turns = SPACE.turns_of(fingers)
    for side in range(2):
        for column in range(SPACE.size):
            ahead = hands.copy()
            ahead[side, column] += delta
            own = slice(15 * side, 15 * (side + 1))
            expected = fingers_by_turns(fingers[own], delta * turns[side, :, column].reshape(15, 3))
            assert np.abs(expected - SPACE.fingers_of(ahead)[own]).max() < 1e-10, (side, column)


def test_a_reduced_jacobian_keeps_what_is_no_finger_and_combines_the_rest() -> None:
    rng = np.random.default_rng(3)
    fingers = SPACE.fingers_of(0.4 * rng.standard_normal((2, 6)))
    full = rng.standard_normal((7, 3, NUM_TURNED + 90 + MODEL.num_shape))
    few = reduce_jacobian(SPACE, fingers, full)
    assert few.shape == (7, 3, WIDTH)
    assert np.array_equal(few[:, :, :NUM_TURNED], full[:, :, :NUM_TURNED])
    assert np.array_equal(few[:, :, NUM_TURNED + 12 :], full[:, :, NUM_TURNED + 90 :])
    step = rng.standard_normal((2, 6))
    turns = np.concatenate([SPACE.turns_of(fingers)[k] @ step[k] for k in range(2)])
    by_turns = full[:, :, NUM_TURNED : NUM_TURNED + 90] @ turns
    assert np.allclose(few[:, :, NUM_TURNED : NUM_TURNED + 12] @ step.ravel(), by_turns)


@settings(max_examples=15, deadline=None)
@given(seeds, st.integers(1, 12))
def test_hands_of_any_width_are_cut_or_filled_with_the_mean(seed: int, width: int) -> None:
    hands = np.random.default_rng(seed).standard_normal((2, width))
    made, given_later = make_state(MODEL, SPACE, hands=hands), with_hands(draw_state(seed), SPACE, hands)
    count = min(6, width)
    for state in (made, given_later):
        assert np.array_equal(state.hands[:, :count], hands[:, :count]) and not state.hands[:, count:].any()
    assert np.array_equal(made.pose[22:], given_later.pose[22:])


def test_the_larger_space_begins_with_the_smaller() -> None:
    larger = hand_space(MODEL, 20)
    assert np.array_equal(larger.components[:, :6], SPACE.components) and np.array_equal(larger.means, SPACE.means)
