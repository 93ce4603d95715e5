"""An object is told lost by the share of its contour that lies on edges."""

from __future__ import annotations

import numpy as np

from tests.tracker.search.test_place_in_views import look_from
from tracker.fitting.contour_quality import FEW, measure_contour_quality
from tracker.model.ball import make_ball
from tracker.model.scene import Scene
from tracker.observation.image_edges import find_image_edges
from tracker.rendering import render_view
from tracker.terms.contours import Contours

BALL = Scene((make_ball(0.03),))


def see_ball(angle: float) -> Contours:
    """A pale ball in the middle of the world before a dark wall."""
    camera = look_from(angle)
    view = render_view(BALL.pose_at(np.zeros(6)), camera.K, camera.T_world_camera, camera.height, camera.width)
    image = np.repeat(np.where(view.face >= 0, 200, 20).astype(np.uint8)[..., None], 3, axis=2)
    points = np.array([[0.0, 0.0], [camera.width - 1.0, camera.height - 1.0]])
    edges = find_image_edges(image, camera, points, 0.0)
    assert edges is not None
    return Contours(edges)


def test_a_ball_lies_on_its_edges_and_is_lost_8_mm_beside_them():
    views = [see_ball(angle) for angle in (0.0, 1.0)]
    here = measure_contour_quality(BALL.pose_at(np.zeros(6)), views, 0)
    assert here.score > 0.9
    assert not here.is_lost
    aside = measure_contour_quality(BALL.pose_at(np.array([0.0, 0.008, 0.0, 0.0, 0.0, 0.0])), views, 0)
    assert aside.visible > FEW
    assert aside.is_lost


def test_a_ball_that_no_view_shows_is_hidden_and_not_lost():
    behind = measure_contour_quality(BALL.pose_at(np.array([0.0, 9.0, 0.0, 0.0, 0.0, 0.0])), [see_ball(0.0)], 0)
    assert behind.is_hidden
    assert not behind.is_lost
    assert measure_contour_quality(BALL.pose_at(np.zeros(6)), [], 0).is_hidden
