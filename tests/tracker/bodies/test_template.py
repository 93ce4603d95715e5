"""Unposing takes a pose away to the last digit, and a template is what its registrations have in common."""

from __future__ import annotations

import numpy as np

from tracker.bodies.body_registration import BodyRegistration
from tracker.bodies.body_state import BodyState, hand_space, make_state
from tracker.bodies.template import make_template, unpose
from tracker.model.body_hands import body_hand
from tracker.model.body_model import body_model


def registered(seed: int, shown: tuple[bool, bool] = (True, True), spoilt: tuple[int, ...] = ()) -> BodyRegistration:
    """The model itself in some pose as a registration; the hands of these sides (0, 1) are 20 mm off."""
    rng, model = np.random.default_rng(seed), body_model()
    start = make_state(
        model, hand_space(model, 6), 0.3 * rng.standard_normal((22, 3)), 0.3 * rng.standard_normal((2, 6))
    )
    state = BodyState(start.pose, 0.5 * np.ones(model.num_shape), rng.standard_normal(3), start.hands)
    vertices = state.posed(model).vertices.copy()
    for k in spoilt:
        vertices[body_hand(model, ("left", "right")[k]).vertices] += 0.02
    return BodyRegistration(vertices, vertices, state, shown, np.zeros(0), "good", ())


def test_a_posed_model_unposed_is_its_person_at_rest() -> None:
    each = registered(1)
    assert np.abs(unpose(body_model(), each) - body_model().shaped(each.state.shape)).max() < 1e-9


def test_a_template_leaves_out_hands_that_no_scan_shows_and_has_no_shape_left() -> None:
    found = [registered(1), registered(2, (True, False), (1,)), registered(3, (False, True), (0,)), registered(4)]
    own = make_template(body_model(), found)
    assert own.num_shape == 0
    assert np.abs(own.template - body_model().shaped(found[0].state.shape)).max() < 1e-9
