"""Nails are looked for in the views that show colour and a hand, each by itself."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.fitting.test_setup import small_forest
from tests.tracker.search.test_place_in_views import look_from
from tests.tracker.terms.test_nails import CAMERAS, SCENE
from tracker.capture.camera import Camera
from tracker.capture.frame import CameraFrame, Frame
from tracker.search.find_nails import find_nails_in_views

FOREST = replace(small_forest(), kind="color", what="nails")
"""It finds nothing anywhere."""
POSED = SCENE.pose_at(SCENE.rest_pose())


def view(camera: Camera, with_color: bool = True) -> CameraFrame:
    color = np.full((camera.height, camera.width, 3), 90, np.uint8) if with_color else None
    return CameraFrame(camera, Frame(0, camera.id, color, None))


def test_views_without_colour_or_without_a_hand_are_left_out_and_the_others_keep_their_order() -> None:
    away = replace(CAMERAS[0], id="away", T_world_camera=CAMERAS[0].T_world_camera @ np.diag([-1.0, 1.0, -1.0, 1.0]))
    views = [view(CAMERAS[2]), view(CAMERAS[1], False), view(away), view(CAMERAS[0])]
    nails = find_nails_in_views(FOREST, POSED, views)
    assert [seen.camera.id for seen in nails.views] == [CAMERAS[2].id, CAMERAS[0].id]
    assert all(seen.pixels.shape == (0, 2) and seen.is_visible[1:].all() for seen in nails.views)
    assert nails.find(POSED).count == 0


def test_a_second_thread_changes_nothing_and_no_views_show_none() -> None:
    views = [view(camera) for camera in CAMERAS]
    one, two = (find_nails_in_views(FOREST, POSED, views, threads) for threads in (1, 2))
    for a, b in zip(one.views, two.views, strict=True):
        np.testing.assert_array_equal(a.is_visible, b.is_visible)
    assert find_nails_in_views(FOREST, POSED, []).views == []


def test_a_distorted_view_is_looked_at_as_an_ideal_camera_would_see_it() -> None:
    bent = look_from(3.1)
    assert bent.distortion.any()
    (seen,) = find_nails_in_views(FOREST, POSED, [view(bent)]).views
    assert not seen.camera.distortion.any()
    np.testing.assert_array_equal(seen.camera.K, bent.K)


@pytest.mark.parametrize("other", [{"kind": "depth"}, {"what": "fingertips"}])
def test_a_detector_of_something_else_is_not_asked(other) -> None:
    with pytest.raises(AssertionError):
        find_nails_in_views(replace(FOREST, **other), POSED, [])
