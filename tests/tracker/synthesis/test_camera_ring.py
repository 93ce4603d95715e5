"""Cameras of a ring look at one point from as far as the first, and any two see it from sides that triangulate."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tracker.capture.camera import Camera
from tracker.capture.triangulation import triangulate
from tracker.geometry import se3
from tracker.synthesis.camera_ring import DIRECTIONS_DEG, surround

K = np.array([[500.0, 0.0, 319.5], [0.0, 500.0, 239.5], [0.0, 0.0, 1.0]])
CENTER = np.array([0.05, -0.02, 0.5])


def first(twist=(0.1, -0.2, 0.3, 0.2, -0.3, 0.1)) -> tuple[Camera, np.ndarray]:
    """A camera somewhere in the world, and the point before it that all look at."""
    T = se3.exp(np.array(twist))
    return Camera("cam0", 640, 480, K, T_world_camera=T), T[:3, :3] @ CENTER + T[:3, 3]


@settings(max_examples=25, deadline=None)
@given(st.lists(st.floats(-1, 1), min_size=6, max_size=6), st.integers(0, len(DIRECTIONS_DEG)))
def test_every_camera_has_the_point_at_the_same_place_in_its_picture_and_as_far_away(twist, count) -> None:
    camera, center = first(twist)
    ring = surround(camera, center, count)
    assert [each.id for each in ring] == [f"cam{number + 1}" for number in range(count)]
    for each in ring:
        assert np.allclose(se3.transform(each.T_camera_world, center[None])[0], CENTER, atol=1e-9)
        assert np.array_equal(each.K, camera.K)
        assert np.allclose(each.T_world_camera[:3, :3] @ each.T_world_camera[:3, :3].T, np.eye(3), atol=1e-9)


def test_no_two_cameras_stand_together_or_face_each_other_so_that_any_two_find_the_point() -> None:
    camera, center = first()
    for a, b in combinations((camera, *surround(camera, center, len(DIRECTIONS_DEG))), 2):
        towards = [center - each.T_world_camera[:3, 3] for each in (a, b)]
        cosine = towards[0] @ towards[1] / np.prod([np.linalg.norm(t) for t in towards])
        assert 15.0 < np.degrees(np.arccos(cosine)) < 170.0, (a.id, b.id)
        marks = np.stack([each.project(center[None]) for each in (a, b)], axis=1)
        assert np.allclose(triangulate([a, b], marks).points[0], center, atol=1e-6)


def test_the_first_direction_is_to_the_side_that_its_azimuth_says() -> None:
    camera = Camera("cam0", 640, 480, K, T_world_camera=np.eye(4))
    (aside,) = surround(camera, np.array([0.0, 0.0, 1.0]), 1)
    assert aside.T_world_camera[:3, 3] == pytest.approx([np.sqrt(0.5), 0.0, 1.0 - np.sqrt(0.5)], abs=1e-9)
