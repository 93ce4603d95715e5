"""The part of an image around posed hands, where nails are looked for."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.grips import ball
from tests.tracker.terms.test_nails import CAMERAS, SCENE
from tracker.geometry import se3
from tracker.model.scene import Scene
from tracker.rendering import render_view
from tracker.rendering.seen_nails import NailPlaces
from tracker.search.nail_views import draw_nail_view

CAMERA = CAMERAS[1]
"""It looks at the back of the hand."""
COLOR = np.random.default_rng(0).integers(0, 255, (CAMERA.height, CAMERA.width, 3), dtype=np.uint8)


def whole_depth(posed) -> np.ndarray:
    return render_view(posed, CAMERA.K, CAMERA.T_world_camera, CAMERA.height, CAMERA.width).depth


def test_what_is_cut_out_holds_the_hand_and_shows_the_nails_that_the_whole_image_does() -> None:
    posed, places = SCENE.pose_at(SCENE.rest_pose()), NailPlaces.of(SCENE)
    found = draw_nail_view(posed, places, CAMERA, COLOR)
    assert found is not None
    region, depth = found.region, whole_depth(posed)
    rows, columns = np.nonzero(depth)
    assert region.row <= rows.min() and rows.max() < region.row + region.height <= CAMERA.height
    assert region.column <= columns.min() and columns.max() < region.column + region.width <= CAMERA.width
    expected = places.find_visible(posed.vertices, CAMERA, depth, np.zeros(2))
    np.testing.assert_array_equal(found.is_visible, expected)
    assert expected[1:].all()


def test_a_thing_before_the_hand_hides_nails_and_is_none_of_it() -> None:
    scene = Scene((*SCENE.models, ball(0.03)))
    places = NailPlaces.of(scene)
    pose = scene.rest_pose()
    point = places.points(scene.pose_at(pose).vertices)[2]
    eye = CAMERA.T_world_camera[:3, 3]
    pose[scene.pose_slices[1]][:3] = point + 0.1 * (eye - point) / np.linalg.norm(eye - point)
    alone = draw_nail_view(SCENE.pose_at(SCENE.rest_pose()), NailPlaces.of(SCENE), CAMERA, COLOR)
    found = draw_nail_view(scene.pose_at(pose), places, CAMERA, COLOR)
    assert alone is not None and found is not None
    assert alone.is_visible[2] and not found.is_visible[2]
    assert np.count_nonzero(found.image.depth) < np.count_nonzero(alone.image.depth)


@pytest.mark.parametrize("away", [[0.0, 0.0, 5.0], [3.0, 0.0, 0.0]], ids=["behind the camera", "beside the image"])
def test_a_hand_that_is_not_in_the_image_gives_no_part_of_it(away) -> None:
    pose = SCENE.rest_pose()
    forward = CAMERA.T_world_camera[:3, :3]
    pose[:3] = forward @ (np.array(away) * [1.0, 1.0, -1.0])
    assert draw_nail_view(SCENE.pose_at(pose), NailPlaces.of(SCENE), CAMERA, COLOR) is None


def test_a_thing_alone_gives_no_part_of_the_image() -> None:
    scene = Scene((ball(0.03),))
    assert (whole_depth(scene.pose_at(scene.rest_pose())) > 0.0).any()
    assert draw_nail_view(scene.pose_at(scene.rest_pose()), NailPlaces.of(scene), CAMERA, COLOR) is None


def test_a_scene_and_camera_that_are_moved_together_show_the_same() -> None:
    T = se3.exp(np.array([0.4, -0.2, 0.7, 0.3, -0.8, 0.5]))
    pose = SCENE.rest_pose()
    pose[:6] = se3.log(T @ se3.exp(pose[:6]))
    moved = replace(CAMERA, T_world_camera=T @ CAMERA.T_world_camera)
    one = draw_nail_view(SCENE.pose_at(SCENE.rest_pose()), NailPlaces.of(SCENE), CAMERA, COLOR)
    other = draw_nail_view(SCENE.pose_at(pose), NailPlaces.of(SCENE), moved, COLOR)
    assert one is not None and other is not None
    np.testing.assert_array_equal(other.is_visible, one.is_visible)
    assert abs(other.region.row - one.region.row) <= 1 and abs(other.region.column - one.region.column) <= 1
