"""In colour views a run begins with hands nowhere, objects where somebody placed them, and no others."""

from __future__ import annotations

import logging
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.tracker.grips import ball, cube
from tracker.capture.recorded_object import RecordedObject
from tracker.capture.sequence import Sequence
from tracker.fitting.options import TrackOptions
from tracker.fitting.setup import TrackSetup
from tracker.geometry import se3
from tracker.model.default_hand import default_hand
from tracker.tracking.start_views import start_views

RIGHT, LEFT = default_hand("right"), default_hand("left")
T = se3.exp(np.array([0.1, 0.2, 0.7, 0.4, -1.0, 0.2]))
BALL, CUBE = RecordedObject("ball", "ball.ply", T), RecordedObject("cube", "cube.ply")
SETUP = TrackSetup(
    ("ball", "right", "cube", "left"), (ball(), RIGHT, cube(), LEFT), "a", TrackOptions(), view_ids=("a", "b")
)
SEQUENCE = Sequence(Path(), "made", 30.0, 9, (), ("right", "left"), (BALL, CUBE))
AS_GIVEN = TrackOptions(calibrate=False)


def begin(setup: TrackSetup, sequence: Sequence = SEQUENCE, frames: range = range(3, 9)):
    told = []
    result = start_views(sequence, setup, frames, lambda *each: told.append(each))
    return *result, told


def test_hands_are_nowhere_and_all_of_them_yet_to_be_found():
    setup, state, told = begin(replace(SETUP, options=AS_GIVEN))
    assert (state.next_frame, state.is_lost, told) == (3, True, [])
    assert state.gone_hands(setup) == setup.hands == (0, 1)
    for hand in setup.hands:
        np.testing.assert_array_equal(state.pose[setup.scene.pose_slices[hand]], 0.0)
    np.testing.assert_array_equal(state.pose, state.earlier_pose)


def test_a_placed_object_stands_behind_the_hands_where_it_was_and_one_that_nobody_placed_is_left_out(caplog):
    with caplog.at_level(logging.WARNING):
        setup, state, _ = begin(replace(SETUP, options=AS_GIVEN))
    assert setup.names == ("right", "left", "ball")
    assert setup.models == (RIGHT, LEFT, SETUP.models[0])
    np.testing.assert_allclose(se3.exp(state.pose[setup.scene.pose_slices[2]]), T, atol=1e-9)
    assert [record.args for record in caplog.records] == [("cube",)]
    assert "initial.T_world_object" in caplog.text


def test_without_objects_nothing_is_left_out_and_models_keep_their_order():
    hands = TrackSetup(("left", "right"), (LEFT, RIGHT), "a", AS_GIVEN, view_ids=("a", "b"))
    setup, state, _ = begin(hands, replace(SEQUENCE, objects=()))
    assert setup.names == hands.names and setup.models == hands.models
    assert len(state.pose) == LEFT.num_dofs + RIGHT.num_dofs


@pytest.mark.parametrize(
    "setup",
    [
        replace(SETUP, options=AS_GIVEN),
        replace(SETUP, view_ids=("a",)),
        replace(SETUP, models=tuple(replace(model, shape=None) for model in SETUP.models)),
    ],
    ids=["nobody asked", "one view alone", "no hand has a shape"],
)
def test_shapes_that_cannot_be_fitted_stay_and_no_image_is_read(setup):
    begun, _, told = begin(setup)
    assert begun.models == (setup.models[1], setup.models[3], setup.models[0])
    assert told == []
