"""The size of an object is measured whose mesh has the right form only."""

import numpy as np
import pytest

from benchmarks.object_scale import ScaleView, find_scale, with_scale
from tests.tracker.search.drawn_objects import CAMERA, draw_frame, load_mesh
from tests.tracker.search.test_find_object import place
from tracker.observation import Preprocessing


@pytest.mark.slow
def test_the_size_of_a_mesh_is_measured_within_three_percent(tmp_path):
    for name, scale in (("ball", 1.15), ("bracket", 0.85)):
        model = load_mesh(tmp_path, name)
        true = with_scale(model, scale)
        views = []
        for turn in ([0.3, 0.4, 0.2], [-0.5, 0.2, 1.0]):
            drawn = draw_frame(true, place(true, np.array(turn)), coloured=True)
            views.append(ScaleView(drawn.frame, CAMERA, [(drawn.hand, drawn.hand_pose)]))
        assert abs(find_scale(model, views, Preprocessing()) / scale - 1.0) < 0.03
