"""Depth of a plane has the plane's points and its normal in every pixel; a step in depth is no surface."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from tracker.geometry import se3
from tracker.observation.normals import MAX_STEP, compute_points_and_normals_into

K = np.array([[200.0, 0.0, 15.5], [0.0, 190.0, 11.5], [0.0, 0.0, 1.0]])
HEIGHT, WIDTH = 24, 32


def rays() -> np.ndarray:
    """(H, W, 3) camera, z = 1."""
    rows, columns = np.mgrid[:HEIGHT, :WIDTH]
    return np.stack([(columns - K[0, 2]) / K[0, 0], (rows - K[1, 2]) / K[1, 1], np.ones_like(rows, float)], axis=2)


def plane(normal: np.ndarray, distance: float) -> np.ndarray:
    """(H, W) float32 m: depth of the plane normal · x = -distance, camera."""
    return (-distance / (rays() @ normal)).astype(np.float32)


def compute(depth: np.ndarray, T: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    points, normals = (np.zeros((HEIGHT, WIDTH, 3), np.float32) for _ in range(2))
    compute_points_and_normals_into(points, normals, depth, K, T)
    return points, normals


@settings(max_examples=40, deadline=None)
@given(
    st.floats(-0.6, 0.6), st.floats(-0.6, 0.6), st.floats(0.3, 1.0), st.lists(st.floats(-1, 1), min_size=6, max_size=6)
)
def test_a_plane_has_one_normal_towards_the_camera_wherever_that_stands(x, y, distance, twist) -> None:
    normal = np.array([x, y, -1.0]) / np.linalg.norm([x, y, -1.0])
    T = se3.exp(np.array(twist))
    depth = plane(normal, distance)
    points, normals = compute(depth, T)
    assert np.allclose(points, (rays() * depth[..., None]) @ T[:3, :3].T + T[:3, 3], atol=1e-5)
    assert np.abs(normals - T[:3, :3] @ normal).max() < 5e-3, "float32 depth, differences over 4 px"
    assert np.einsum("hwx,hwx->hw", normals, T[:3, 3] - points).min() > 0.0


def test_both_sides_of_a_step_keep_their_own_normal_and_take_nothing_from_each_other() -> None:
    tilted = np.array([0.3, 0.0, -1.0]) / np.hypot(0.3, 1.0)
    depth = plane(tilted, 0.4)
    depth[:, WIDTH // 2 :] += np.float32(4 * MAX_STEP)
    _, normals = compute(depth, np.eye(4))
    assert np.abs(normals[:, : WIDTH // 2] - tilted).max() < 5e-3
    assert np.ptp(normals[:, WIDTH // 2 :, 1]) < 5e-3 and np.abs(np.linalg.norm(normals, axis=2) - 1.0).max() < 1e-5


def test_a_pixel_without_depth_has_neither_point_nor_normal_and_one_alone_has_no_normal() -> None:
    depth = np.zeros((HEIGHT, WIDTH), np.float32)
    depth[5, 7] = 0.5
    points, normals = compute(depth, np.eye(4))
    assert points[5, 7, 2] == 0.5 and np.count_nonzero(points[..., 2]) == 1 and not normals.any()
