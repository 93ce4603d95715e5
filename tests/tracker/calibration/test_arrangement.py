"""Residuals are projected minus seen, whatever moves with what; boards and doubts of cameras come from them."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.tracker.calibration.true_cameras import CORNERS, FILMED, TIMES, TRUTH
from tracker.calibration.arrangement import Corners
from tracker.calibration.bundle import Freedom, Layout, find_jacobian
from tracker.geometry.se3 import exp


def test_in_the_true_places_nothing_is_off_and_centres_are_the_cameras() -> None:
    assert np.abs(TRUTH.residuals(CORNERS)).max() < 1e-6, "px"
    centres = np.array([camera.T_world_camera[:3, 3] for camera in FILMED.cameras])
    assert np.allclose(TRUTH.find_centres(), centres, atol=1e-12)
    assert np.allclose(TRUTH.find_baselines(), np.linalg.norm(centres - centres[0], axis=1))


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_residuals_are_opencvs_projection_minus_what_was_seen(seed) -> None:
    rng = np.random.default_rng(seed)
    moved = np.array([T @ exp(0.02 * rng.standard_normal(6)) for T in TRUTH.T_camera_world])
    off = replace(TRUTH, T_camera_world=moved, offsets=0.01 * rng.standard_normal(3))
    drifting = replace(CORNERS, velocity=rng.standard_normal(CORNERS.pixels.shape))
    residuals = off.residuals(drifting)
    for number in rng.integers(0, len(CORNERS.camera), 10):
        camera = CORNERS.camera[number]
        T = moved[camera] @ TRUTH.T_world_board[CORNERS.moment[number]]
        seen, _ = cv2.projectPoints(
            CORNERS.points[number][None],
            cv2.Rodrigues(T[:3, :3])[0],
            T[:3, 3],
            TRUTH.K[camera],
            TRUTH.distortion[camera],
        )
        expected = seen[0, 0] - CORNERS.pixels[number] - off.offsets[camera] * drifting.velocity[number]
        assert np.allclose(residuals[number], expected, atol=1e-6)


@settings(max_examples=15, deadline=None)
@given(st.lists(st.floats(-1, 1), min_size=6, max_size=6))
def test_moving_the_whole_world_changes_no_residual(twist) -> None:
    T = exp(np.array(twist))
    moved = replace(
        TRUTH, T_camera_world=TRUTH.T_camera_world @ np.linalg.inv(T), T_world_board=T @ TRUTH.T_world_board
    )
    assert np.abs(moved.residuals(CORNERS)).max() < 1e-6


def test_what_lies_behind_a_camera_has_a_large_and_finite_residual() -> None:
    behind = replace(TRUTH, T_camera_world=np.diag([1.0, -1.0, -1.0, 1.0]) @ TRUTH.T_camera_world)
    residuals = behind.residuals(CORNERS)
    assert np.isfinite(residuals).all() and np.linalg.norm(residuals, axis=1).min() > 1000.0


def problem(freedom: Freedom) -> tuple[Layout, np.ndarray]:
    layout = Layout(3, len(TIMES), freedom)
    J = find_jacobian(TRUTH, layout, CORNERS, freedom, np.zeros(layout.size))
    return layout, J


def test_chosen_corners_keep_all_that_belongs_to_them() -> None:
    few = CORNERS.choose(CORNERS.camera == 2)
    assert set(few.camera) == {2} and len(few.points) == len(few.velocity) == (CORNERS.camera == 2).sum()
    assert isinstance(few, Corners) and np.array_equal(few.pixels, CORNERS.pixels[CORNERS.camera == 2])
