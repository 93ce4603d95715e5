"""A point comes back from its images; bad marks are found, hopeless views refused."""

from __future__ import annotations

import time

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tracker.capture.camera import Camera
from tracker.capture.triangulation import triangulate
from tracker.geometry import se3

BENT = np.array([-0.28, 0.09, 0.0011, -0.0007, 0.01])


def look_at(name: str, azimuth_deg: float, distance: float = 0.6, distortion: np.ndarray = BENT) -> Camera:
    """A camera on a circle about the world's origin that looks at it."""
    K = np.array([[520.0, 0, 321.0], [0, 518.0, 238.0], [0, 0, 1]])
    T = np.eye(4)
    T[:3, 3] = [0, 0, -distance]
    turn = se3.exp(np.array([0, 0, 0, 0, np.radians(azimuth_deg), 0]))
    return Camera(name, 640, 480, K, distortion, turn @ T)


def ring(count: int, distortion: np.ndarray = BENT) -> list[Camera]:
    return [look_at(f"cam{k}", 35.0 * k, distortion=distortion) for k in range(count)]


def see(cameras: list[Camera], points: np.ndarray) -> np.ndarray:
    return np.stack([camera.project(points) for camera in cameras], axis=1)


@settings(max_examples=60, deadline=None)
@given(
    point=st.tuples(*[st.floats(-0.12, 0.12)] * 3),
    count=st.integers(2, 6),
    twist=st.tuples(*[st.floats(-2.0, 2.0)] * 6),
)
def test_the_exact_point_comes_back_wherever_the_world_has_its_origin(point, count, twist):
    moved = se3.exp(np.array(twist))
    cameras = [Camera(c.id, c.width, c.height, c.K, c.distortion, moved @ c.T_world_camera) for c in ring(count)]
    points = se3.transform(moved, np.array([point]))
    found = triangulate(cameras, see(cameras, points))
    assert found.refusals == ("",)
    np.testing.assert_allclose(found.points, points, atol=1e-7)
    assert found.residuals.max() < 1e-3
    assert found.is_used.all()


def test_two_views_without_distortion_agree_with_opencv(rng):
    cameras = ring(2, np.zeros(0))
    points = rng.uniform(-0.1, 0.1, (50, 3))
    marks = see(cameras, points)
    found = triangulate(cameras, marks)
    P = [camera.K @ camera.T_camera_world[:3] for camera in cameras]
    X = cv2.triangulatePoints(P[0], P[1], marks[:, 0].T, marks[:, 1].T)
    np.testing.assert_allclose(found.points, (X[:3] / X[3]).T, atol=1e-7)


def test_the_point_has_the_least_squared_distance_in_the_images(rng):
    cameras = ring(4)
    marks = see(cameras, rng.uniform(-0.1, 0.1, (30, 3))) + rng.normal(0, 1.0, (30, 4, 2))
    found = triangulate(cameras, marks)
    assert found.is_used.all()

    def cost(points: np.ndarray) -> np.ndarray:
        return ((see(cameras, points) - marks) ** 2).sum(axis=(1, 2))

    least = cost(found.points)
    for step in 1e-4 * np.vstack([np.eye(3), -np.eye(3)]):
        assert np.all(cost(found.points + step) > least)


def test_the_error_is_as_large_as_it_says(rng):
    cameras, point = ring(3), np.array([[0.03, -0.02, 0.01]])
    marks = np.repeat(see(cameras, point), 2000, axis=0) + rng.normal(0, 1.0, (2000, 3, 2))
    found = triangulate(cameras, marks)
    worst = np.sqrt(np.linalg.eigvalsh(np.cov((found.points - point).T))[-1])
    assert np.median(found.std_m) == pytest.approx(worst, rel=0.06)


def test_a_view_that_is_left_out_tells_how_far_it_is_off(rng):
    cameras, points = ring(4), rng.uniform(-0.05, 0.05, (21, 3))
    marks = see(cameras, points)
    marks[7, 2] += [9.0, -12.0]
    found = triangulate(cameras, marks)
    assert found.left_out_residuals[7, 2] == pytest.approx(15.0, abs=1e-3)
    assert found.left_out_residuals[7].argmax() == 2
    np.testing.assert_array_equal(found.is_used[7], [True, True, False, True])
    assert found.residuals[7, 2] == pytest.approx(15.0, abs=1e-3)
    np.testing.assert_allclose(found.points, points, atol=1e-6)
    assert np.delete(found.left_out_residuals, 7, axis=0).max() < 1e-3


def test_of_three_views_the_bad_one_is_set_aside_when_it_is_clear_which(rng):
    cameras, points = ring(3), rng.uniform(-0.05, 0.05, (200, 3))
    marks = see(cameras, points) + rng.normal(0, 0.5, (200, 3, 2))
    bad = rng.integers(0, 3, 200)
    marks[np.arange(200), bad] += 30.0 * np.array([0.0, 1.0])  # across the epipolar lines of this ring
    found = triangulate(cameras, marks)
    is_set_aside = ~found.is_used
    assert not is_set_aside[np.arange(200), (bad + 1) % 3].any(), "never a good one"
    assert is_set_aside[np.arange(200), bad].mean() > 0.9


def test_ordinary_noise_sets_nothing_aside(rng):
    cameras = ring(5)
    marks = see(cameras, rng.uniform(-0.05, 0.05, (500, 3))) + rng.normal(0, 1.46, (500, 5, 2))
    assert triangulate(cameras, marks).is_used.mean() > 0.999


def test_two_views_leave_nobody_out():
    cameras = ring(2)
    found = triangulate(cameras, see(cameras, np.zeros((1, 3))))
    assert np.isnan(found.left_out_residuals).all()


def test_one_view_is_refused():
    cameras = ring(3)
    marks = see(cameras, np.zeros((2, 3)))
    marks[0, 1:] = np.nan
    marks[1] = np.nan
    found = triangulate(cameras, marks)
    assert [refusal[:11] for refusal in found.refusals] == ["Marked in 1", "Marked in 0"]
    assert np.isnan(found.points).all() and np.isnan(found.residuals).all()
    assert not found.is_used.any()


def test_nearly_parallel_rays_are_refused_and_so_are_those_that_face_each_other():
    points = np.array([[0.0, 0.0, 0.0]])
    for other in (0.6, 179.7):
        cameras = [look_at("a", 0.0), look_at("b", other)]
        found = triangulate(cameras, see(cameras, points))
        assert "nearly parallel" in found.refusals[0]
        assert np.isnan(found.points).all()
        assert found.angles_deg[0] < 1.0
    cameras = [look_at("a", 0.0), look_at("b", 1.5)]
    assert triangulate(cameras, see(cameras, points)).refusals == ("",)


def test_rays_that_meet_behind_the_cameras_are_refused():
    cameras = ring(2, np.zeros(0))
    marks = see(cameras, np.zeros((1, 3)))
    marks[0, 0, 0] += 200
    marks[0, 1, 0] -= 200
    found = triangulate(cameras, marks)
    assert "do not meet in front" in found.refusals[0]


def test_a_mark_where_the_lens_lets_nothing_be_seen_is_refused():
    cameras = ring(2, np.array([-0.4, 0.0, 0.0, 0.0]))
    marks = see(cameras, np.zeros((1, 3)))
    marks[0, 1] = [10_000.0, 10_000.0]
    found = triangulate(cameras, marks)
    assert "calibrated lens" in found.refusals[0]


def test_no_points_are_no_trouble():
    found = triangulate(ring(3), np.zeros((0, 3, 2)))
    assert found.points.shape == (0, 3) and found.refusals == ()


def test_a_hand_in_eight_views_takes_some_milliseconds(rng):
    cameras = ring(8)
    marks = see(cameras, rng.uniform(-0.05, 0.05, (21, 3))) + rng.normal(0, 1.0, (21, 8, 2))
    triangulate(cameras, marks)
    times = []
    for _ in range(5):
        began = time.process_time()
        triangulate(cameras, marks)
        times.append(time.process_time() - began)
    assert min(times) < 0.05
