"""Nails are seen where they look at the camera and nothing stands before them; a flat one says nothing."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tracker.toys import tube
from tracker.capture.camera import Camera
from tracker.geometry import se3
from tracker.model.default_hand import default_hand
from tracker.model.nails import find_nails
from tracker.model.scene import Scene
from tracker.rendering.seen_nails import NailPlaces

SIZE = 64
K = np.array([[160.0, 0.0, 31.5], [0.0, 160.0, 31.5], [0.0, 0.0, 1.0]])
NOTHING = np.zeros((SIZE, SIZE))


@pytest.fixture(scope="module")
def scene() -> Scene:
    return Scene((default_hand("right"), default_hand("left")))


@pytest.fixture(scope="module")
def vertices(scene) -> np.ndarray:
    return scene.pose_at(scene.rest_pose()).vertices


def look_at(point: np.ndarray, direction: np.ndarray, distance: float = 0.3) -> Camera:
    """A camera so far from a point, that looks against a direction."""
    z = -direction / np.linalg.norm(direction)
    x = np.cross([0.3, 1.0, 0.2], z)
    x /= np.linalg.norm(x)
    T = np.eye(4)
    T[:3, :3] = np.stack([x, np.cross(z, x), z], axis=1)
    T[:3, 3] = point - distance * z
    return Camera("cam0", SIZE, SIZE, K, T_world_camera=T)


def normal_of(places: NailPlaces, vertices: np.ndarray, nail: int) -> np.ndarray:
    a, b, c = vertices[places.ids[nail]]
    normal = np.cross(b - a, c - a)
    return normal / np.linalg.norm(normal)


def test_places_are_those_of_each_hand_moved_to_where_the_scene_has_it(scene, vertices) -> None:
    places = NailPlaces.of(scene)
    points = places.points(vertices)
    assert len(points) == 10
    for hand, (model, where) in enumerate(zip(scene.models, scene.vertex_slices, strict=True)):
        own = vertices[where]
        expected = [nail.shares @ own[nail.corners] for nail in find_nails(model)]
        assert np.allclose(points[5 * hand : 5 * hand + 5], expected, atol=1e-12)


@pytest.mark.parametrize("nail", range(10))
def test_a_nail_is_visible_from_above_flat_from_its_side_and_neither_from_below(scene, vertices, nail) -> None:
    places = NailPlaces.of(scene)
    point, normal = places.points(vertices)[nail], normal_of(places, vertices, nail)
    aside = np.cross(normal, [0.2, 0.5, 0.9])
    for direction, is_visible, is_flat in ((normal, True, False), (aside, False, True), (-normal, False, False)):
        camera = look_at(point, direction)
        assert places.find_visible(vertices, camera, NOTHING, np.zeros(2))[nail] == is_visible
        assert places.find_flat(vertices, camera)[nail] == is_flat


def test_what_stands_before_a_nail_hides_it_and_its_own_surface_does_not(scene, vertices) -> None:
    places = NailPlaces.of(scene)
    point, normal = places.points(vertices)[2], normal_of(places, vertices, 2)
    camera = look_at(point, normal)
    z = se3.transform(camera.T_camera_world, point[None])[0, 2]
    for before, is_visible in ((0.0, True), (0.001, True), (0.003, False), (0.1, False)):
        depth = np.full((SIZE, SIZE), z - before)
        assert places.find_visible(vertices, camera, depth, np.zeros(2))[2] == is_visible, before


def test_a_part_of_an_image_knows_only_the_nails_in_it(scene, vertices) -> None:
    places = NailPlaces.of(scene)
    camera = look_at(places.points(vertices)[1], normal_of(places, vertices, 1))
    middle = np.array([31, 31])
    assert places.find_visible(vertices, camera, np.zeros((5, 5)), middle - 2)[1]
    assert not places.find_visible(vertices, camera, np.zeros((5, 5)), middle + 10)[1]


def test_a_scene_without_hands_has_no_nails() -> None:
    scene = Scene((tube(),))
    vertices = scene.pose_at(scene.rest_pose()).vertices
    places = NailPlaces.of(scene)
    assert places.points(vertices).shape == (0, 3)
    assert places.find_visible(vertices, look_at(np.zeros(3), np.ones(3)), NOTHING, np.zeros(2)).shape == (0,)
