"""Every derivative of a body's few parameters meets finite differences, and parts of a body are fitted alone."""

from __future__ import annotations

import numpy as np
import pytest

from tracker.bodies.body_fit import Anchor, BodyFit, hand_columns, joint_columns
from tracker.bodies.body_prior import make_body_prior
from tracker.bodies.body_state import BodyState, hand_space, make_state, with_hands
from tracker.bodies.hand_mixture import default_mixture
from tracker.model.body_hands import body_hand
from tracker.model.body_model import body_model

STEP = 1e-6


@pytest.fixture(scope="module")
def fit() -> BodyFit:
    ids = np.arange(0, 6683, 97)
    return BodyFit(body_model(), make_body_prior(), default_mixture(), 6, ids)


@pytest.fixture(scope="module")
def state(fit: BodyFit) -> BodyState:
    rng = np.random.default_rng(5)
    start = make_state(fit.model, fit.space, 0.3 * rng.standard_normal((22, 3)), 0.3 * rng.standard_normal((2, 6)))
    return BodyState(start.pose, rng.standard_normal(fit.model.num_shape), rng.standard_normal(3), start.hands)


def test_the_derivative_of_the_surface_by_the_few_parameters_is_exact(fit, state) -> None:
    jacobian = fit.jacobian(fit.pose(state))
    for column in range(fit.num_all):
        step = np.zeros(fit.num_all)
        step[column] = STEP
        ahead, back = fit.pose(fit.move(state, step)).vertices, fit.pose(fit.move(state, -step)).vertices
        assert np.abs(jacobian[:, :, column] - (ahead - back) / (2 * STEP)).max() < 1e-7, column


def test_the_gradient_of_priors_and_of_what_a_pose_is_held_to_is_exact(fit, state) -> None:
    rng = np.random.default_rng(6)
    other = fit.move(state, 0.1 * rng.standard_normal(fit.num_all))
    held = fit.anchored(Anchor(other, 3.0, np.array([2.0, 5.0])))
    _, gradient = held.prior_equations(state, 1.7, 0.4)
    for column in range(fit.num_all):
        step = np.zeros(fit.num_all)
        step[column] = STEP
        change = held.prior_cost(fit.move(state, step), 1.7, 0.4) - held.prior_cost(fit.move(state, -step), 1.7, 0.4)
        assert abs(2.0 * gradient[column] - change / (2 * STEP)) < 1e-4 * max(1.0, abs(gradient[column])), column


def test_a_part_moves_with_its_own_parameters_alone(state) -> None:
    model = body_model()
    hand = body_hand(model, "left")
    columns = np.concatenate([joint_columns(hand.wrist), hand_columns(6, 0)])
    part = BodyFit(model, make_body_prior(), None, 6, hand.vertices, columns)
    moved = part.move(state, np.full(len(columns), 0.1))
    assert isinstance(moved, BodyState)
    before, after = state.posed(model).vertices, moved.posed(model).vertices
    other = body_hand(model, "right").vertices
    assert np.allclose(before[other], after[other], atol=1e-12)
    assert part.pose(state).vertices.shape == (782, 3) and part.jacobian(part.pose(state)).shape == (782, 3, 9)
    assert np.linalg.norm(before - after, axis=1)[hand.vertices].min() > 1e-4


def test_more_components_keep_the_pose_and_fewer_forget_only_the_rest(fit, state) -> None:
    model = body_model()
    more = with_hands(state, hand_space(model, 24), state.hands)
    assert np.allclose(more.pose, state.pose, atol=1e-12)
    again = with_hands(more, fit.space, more.hands)
    assert np.array_equal(again.hands, state.hands)
