"""A hand's state: a step of the model's parameters, and what it poses."""

import numpy as np
import pytest

from tracker.model.untrained_hand import untrained_hand
from tracker.registration.hand_state import HandState


@pytest.fixture
def state() -> HandState:
    rng = np.random.default_rng(0)
    hand = untrained_hand()
    return HandState(0.3 * rng.normal(size=(16, 3)), 0.5 * rng.normal(size=hand.num_shape), np.array([0.1, 0.2, 0.3]))


def test_no_step_leaves_the_hand_where_it_is(state):
    hand = untrained_hand()
    same = state.retract(hand, np.zeros(hand.num_parameters))
    assert same.posed(hand).vertices == pytest.approx(state.posed(hand).vertices, abs=1e-12)


def test_vertices_move_as_their_jacobian_says(state):
    hand = untrained_hand()
    step = 1e-6 * np.random.default_rng(1).normal(size=hand.num_parameters)
    posed = state.posed(hand)
    moved = state.retract(hand, step).posed(hand).vertices - posed.vertices
    assert moved == pytest.approx(posed.vertex_jacobian() @ step, abs=1e-10)


def test_a_step_leaves_the_state_it_began_with(state):
    hand = untrained_hand()
    pose, shape = state.pose.copy(), state.shape.copy()
    state.retract(hand, np.full(hand.num_parameters, 0.1))
    assert (state.pose == pose).all() and (state.shape == shape).all()
