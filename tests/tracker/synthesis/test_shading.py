"""Hands are skin and nothing else is, for the skin detector that the tracker uses."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tracker.observation.skin import compute_skin_log_ratio
from tracker.synthesis.performance import Performance, render_moment
from tracker.synthesis.shading import OBJECT_COLORS, SKIN, compute_cosines, shade


@pytest.mark.parametrize("albedo", [SKIN, *OBJECT_COLORS])
def test_only_hands_have_the_colour_of_skin(performance, albedo):
    (actor,) = performance.actors
    performance = Performance("one colour", 30.0, performance.camera, (replace(actor, albedo=albedo),))
    moment = render_moment(performance, 0)
    color = shade(performance, moment, compute_cosines(performance, moment), np.random.default_rng(0))
    is_skin = compute_skin_log_ratio(color) > 0.0
    assert not is_skin[moment.face < 0].any(), "the background is not skin"
    share = is_skin[moment.face >= 0].mean()
    assert share > 0.995 if albedo == SKIN else share == 0.0


def test_the_cosine_is_one_where_the_surface_faces_the_camera_and_small_at_the_silhouette(performance):
    moment = render_moment(performance, 0)
    cosines = compute_cosines(performance, moment)
    column = 80
    rows = np.flatnonzero(moment.face[:, column] >= 0)
    across = cosines[rows, column]
    assert across[len(across) // 2] > 0.9
    assert across[0] < 0.85
    assert across[-1] < 0.85
    assert np.all(cosines[moment.face < 0] == 0.0)
