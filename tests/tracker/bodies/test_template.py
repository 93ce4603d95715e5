"""Unposing takes a pose away to the last digit, and a template is what its registrations have in common."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tracker.bodies.body_registration import BodyRegistration
from tracker.bodies.body_state import BodyState, hand_space, make_state
from tracker.bodies.template import (
    choose_template_frames,
    find_shape,
    make_own_model,
    make_template,
    unpose,
    without_shape,
)
from tracker.errors import TrackerError
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
    own = make_template(body_model(), ((body_model(), each) for each in found))
    assert own.num_shape == 0
    assert np.abs(own.template - body_model().shaped(found[0].state.shape)).max() < 1e-9


def test_a_registration_that_is_bad_has_no_part_in_the_person_s_model_and_bad_ones_alone_make_none() -> None:
    bad = replace(registered(2, spoilt=(0, 1)), verdict="bad", reasons=("the scan shows only part of a person",))
    own = make_own_model(body_model(), [bad, registered(1)])
    assert np.abs(own.template - body_model().shaped(0.5 * np.ones(body_model().num_shape))).max() < 1e-9
    for found, why in (([bad], "only part of a person"), ([], "none of its scans can be read")):
        with pytest.raises(TrackerError, match=why):
            make_own_model(body_model(), found)


def test_the_frames_of_the_template_are_spread_over_those_at_the_beginning() -> None:
    assert choose_template_frames(range(200)) == [0, 9, 19, 29, 39, 49]
    assert choose_template_frames([0, 2, 7]) == [0, 2, 7]
    assert choose_template_frames([4, 5, 8, 9], count=1) == [4]
    assert choose_template_frames([]) == []


def test_the_person_s_own_model_begins_in_the_pose_that_was_found_and_with_no_shape() -> None:
    each = registered(1)
    state = without_shape(each)
    assert len(state.shape) == 0 and np.array_equal(state.pose, each.state.pose)


def test_the_shape_that_a_template_was_made_with_is_found_again() -> None:
    model = body_model()
    shape = np.random.default_rng(3).standard_normal(model.num_shape)
    own = replace(model, template=model.shaped(shape), shape_directions=np.zeros((len(model.template), 3, 0)))
    assert np.abs(find_shape(model, own) - shape).max() < 0.02, "standard deviations"
