"""Where edges of colour views are looked for."""

from __future__ import annotations

import numpy as np

from tests.tracker.search.test_place_in_views import look_from
from tracker.capture.frame import CameraFrame, Frame
from tracker.tracking.view_edges import find_edges, find_place


def test_a_margin_in_metres_is_as_many_pixels_as_it_looks_large_there():
    camera = look_from(0.0)
    middle = camera.T_world_camera @ np.array([0.0, 0.0, 0.5, 1.0])
    points, margin = find_place(middle[None, :3], camera, 0.02)
    np.testing.assert_allclose(points, camera.K[None, :2, 2], atol=1e-9)
    assert margin == 0.02 * camera.K[0, 0] / 0.5


def test_of_what_is_behind_a_camera_and_of_views_without_colour_there_are_no_edges():
    camera = look_from(0.0)
    behind = (camera.T_world_camera @ np.array([0.0, 0.0, -0.5, 1.0]))[None, :3]
    before = (camera.T_world_camera @ np.array([0.0, 0.0, 0.5, 1.0]))[None, :3]
    assert find_place(behind, camera, 0.02)[0].shape == (0, 2)
    color = np.zeros((camera.height, camera.width, 3), dtype=np.uint8)
    seen, blind = (CameraFrame(camera, Frame(0, camera.id, image, None)) for image in (color, None))
    assert find_edges(behind, [seen], 0.02) == {}
    assert find_edges(before, [blind], 0.02) == {}
    assert list(find_edges(before, [seen], 0.02)) == [camera.id]
