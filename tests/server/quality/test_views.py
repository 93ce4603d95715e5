"""A hand in several cameras: where its joints are, and only where two cameras or more have it."""

from __future__ import annotations

import numpy as np

from server.quality.views import measure_size, triangulate_views
from tests.server.quality.drawn_hands import FAR_M, HAND, K, cameras, seen


def test_joints_are_where_the_views_meet() -> None:
    marks = {(f"cam{number}", 7, "left"): seen(number) for number in range(3)}
    (views,) = triangulate_views(marks, cameras())
    assert (views.frame, views.hand, views.cameras) == (7, "left", ("cam0", "cam1", "cam2"))
    expected = np.c_[(HAND - K[:2, 2]) * FAR_M / K[0, 0], np.full(21, FAR_M)]
    np.testing.assert_allclose(views.points, expected, atol=1e-6)
    assert views.residuals.max() < 1e-4 and views.left_out.max() < 1e-4


def test_the_view_that_disagrees_is_the_one_that_the_others_alone_put_elsewhere() -> None:
    marks = {(f"cam{number}", 0, "right"): seen(number) for number in range(3)}
    marks["cam1", 0, "right"] = seen(1) + np.array([0.0, 30.0])
    (views,) = triangulate_views(marks, cameras())
    assert views.left_out.mean(axis=0).argmax() == 1 and abs(views.left_out[:, 1] - 30.0).max() < 1.0


def test_a_hand_in_one_camera_is_no_view_and_hands_of_other_frames_stay_apart() -> None:
    marks = {("cam0", 0, "right"): HAND, ("cam0", 1, "right"): HAND, ("cam2", 1, "right"): seen(2)}
    (views,) = triangulate_views(marks, cameras())
    assert (views.frame, views.cameras) == (1, ("cam0", "cam2")) and views.residuals.shape == (21, 2)
    assert triangulate_views({("cam0", 0, "right"): HAND}, cameras()) == []


def test_a_joint_that_one_camera_alone_marks_has_no_place() -> None:
    half = seen(1)
    half[8] = np.nan
    (views,) = triangulate_views({("cam0", 0, "right"): HAND, ("cam1", 0, "right"): half}, cameras())
    assert np.isnan(views.points[8]).all() and np.isfinite(np.delete(views.points, 8, axis=0)).all()


def test_the_size_is_the_longer_side_of_what_is_known() -> None:
    assert measure_size(np.array([[0.0, 0.0], [30.0, 40.0], [np.nan, 900.0]])) == 40.0
    assert measure_size(np.full((21, 2), np.nan)) == 0.0
