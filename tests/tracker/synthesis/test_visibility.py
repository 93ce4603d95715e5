"""A joint is occluded when something else is in the way, not by its own flesh."""

from __future__ import annotations

import numpy as np

from tests.tracker.synthesis.conftest import bending_tube
from tracker.synthesis.performance import Performance, render_moment
from tracker.synthesis.visibility import ABSENT, OCCLUDED, VISIBLE, find_visibility


def test_joints_inside_their_own_surface_are_visible(performance):
    for index in range(performance.num_moments):
        assert np.all(find_visibility(performance, render_moment(performance, index)) == VISIBLE)


def test_joints_behind_another_body_are_occluded_and_those_in_front_are_not(camera):
    both = Performance(
        "two tubes", 30.0, camera, (bending_tube(camera, "far", 0.45), bending_tube(camera, "near", 0.4))
    )
    visibility = find_visibility(both, render_moment(both, 0))
    assert visibility[1] == visibility[2] == OCCLUDED
    assert np.all(visibility[3:] == VISIBLE)


def test_joints_outside_the_image_are_absent(camera):
    near = Performance("a tube too near", 30.0, camera, (bending_tube(camera, "tube", 0.08),))
    visibility = find_visibility(near, render_moment(near, 0))
    assert visibility[0] == ABSENT
    assert visibility[1] == VISIBLE
