"""Pixels and rays belong together, with every kind of distortion that OpenCV has."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from tracker.capture.camera import Camera
from tracker.geometry import se3

DISTORTIONS = {
    "none": [],
    "4": [-0.28, 0.09, 0.0011, -0.0007],
    "5": [-0.31, 0.14, 0.0008, 0.0012, -0.04],
    "8": [0.12, -0.21, 0.0004, -0.0006, 0.05, 0.31, -0.12, 0.02],
    "12": [-0.2, 0.05, 0.001, 0.0005, 0.01, 0.02, 0.01, 0.001, 0.003, -0.002, 0.002, 0.001],
    "14": [-0.2, 0.05, 0.001, 0.0005, 0.01, 0.02, 0.01, 0.001, 0.003, -0.002, 0.002, 0.001, 0.03, -0.02],
}


@pytest.fixture(params=DISTORTIONS.values(), ids=DISTORTIONS.keys())
def camera(request) -> Camera:
    K = np.array([[520.0, 0, 311.3], [0, 517.0, 244.9], [0, 0, 1]])
    T_world_camera = se3.exp(np.array([0.1, -0.2, 0.3, 0.2, -0.3, 0.1]))
    return Camera("cam0", 640, 480, K, np.array(request.param, dtype=np.float64), T_world_camera)


def test_a_ray_leads_to_the_pixel_it_comes_from(camera, rng):
    pixels = rng.uniform([-0.5, -0.5], [639.5, 479.5], (500, 2))
    rays = camera.unproject(pixels)
    points = se3.transform(camera.T_world_camera, rays * rng.uniform(0.1, 5.0, (500, 1)))
    np.testing.assert_allclose(camera.project(points), pixels, atol=1e-4)
    assert camera.can_see(points).all()


def test_a_pixel_at_a_depth_is_lifted_to_the_point_that_is_seen_there(camera, rng):
    seen = rng.uniform([-0.2, -0.2, 0.6], [0.2, 0.2, 2.0], (50, 3))
    points = se3.transform(camera.T_world_camera, seen)
    np.testing.assert_allclose(camera.lift(camera.project(points), seen[:, 2]), points, atol=1e-6)


def test_pixels_are_those_of_opencv(camera, rng):
    points = se3.transform(camera.T_world_camera, rng.uniform([-0.2, -0.2, 0.6], [0.2, 0.2, 2.0], (50, 3)))
    T = camera.T_camera_world
    coefficients = camera.distortion if camera.distortion.size else None
    expected = cv2.projectPoints(points, cv2.Rodrigues(T[:3, :3])[0], T[:3, 3], camera.K, coefficients)[0]
    np.testing.assert_allclose(camera.project(points), expected[:, 0], atol=1e-6)


def test_rays_are_those_of_opencv(camera, rng):
    pixels = rng.uniform([150, 100], [490, 380], (200, 2))
    coefficients = camera.distortion if camera.distortion.size else None
    flat = cv2.undistortPoints(pixels[:, None], camera.K, coefficients)[:, 0]
    np.testing.assert_allclose(camera.unproject(pixels)[:, :2], flat, atol=2e-3)


def test_a_pixel_beyond_the_fold_of_the_distortion_has_no_ray():
    K = np.array([[500.0, 0, 320], [0, 500.0, 240], [0, 0, 1]])
    camera = Camera("cam0", 640, 480, K, np.array([-0.4, 0.0, 0.0, 0.0]))
    # x (1 - 0.4 x²) never exceeds 0.6086: 304 px from the centre.
    rays = camera.unproject(np.array([[620.0, 240.0], [627.0, 240.0]]))
    assert np.isfinite(rays[0]).all()
    assert np.isnan(rays[1]).all()
    folded = np.array([[1.4, 0.0, 1.0]])
    assert np.all(np.abs(camera.project(folded) - [320, 240]) < 320), "the formula puts it into the image ..."
    assert not camera.can_see(folded)[0], "... where no such ray comes from"


def test_what_is_behind_or_beside_is_not_seen(camera):
    points_camera = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [5.0, 0.0, 1.0]])
    np.testing.assert_array_equal(
        camera.can_see(se3.transform(camera.T_world_camera, points_camera)), [True, False, False]
    )


def test_no_pixels_have_no_rays(camera):
    assert camera.unproject(np.zeros((0, 2))).shape == (0, 3)
