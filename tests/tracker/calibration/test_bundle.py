"""Bundle adjustment."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import approx_fprime

from tests.tracker.calibration.filmed_board import film, place_board
from tracker.calibration.bundle import (
    Arrangement,
    Corners,
    Freedom,
    Layout,
    _move,
    adjust,
    find_jacobian,
    find_residuals,
)
from tracker.calibration.eliminated_scale import EliminatedScale
from tracker.calibration.moments import read_corners
from tracker.geometry.se3 import exp


def make_problem(moments: int = 4) -> tuple[Arrangement, Corners]:
    """Three cameras and the board at some moments, all in their true places."""
    filmed = film(3, seconds=6.0, fps=10.0)
    times = np.arange(moments) * 0.4
    corners = read_corners(filmed.board, filmed.sight_all(noise_px=0.0), times, np.zeros(3), np.ones(3, dtype=bool))
    distortion = np.zeros((3, 12))
    distortion[:, :5] = [camera.distortion for camera in filmed.cameras]
    return Arrangement(
        np.array([camera.K for camera in filmed.cameras]),
        distortion,
        np.array([camera.T_camera_world for camera in filmed.cameras]),
        np.array([place_board(filmed.board, time) for time in times]),
        np.zeros(3),
        np.array([[camera.width, camera.height] for camera in filmed.cameras], dtype=np.float64),
    ), corners


@pytest.mark.parametrize("freedom", [Freedom(), Freedom(lenses=False), Freedom(False, False, False)])
def test_the_jacobian_meets_differences_by_one_parameter_at_a_time(freedom: Freedom, rng: np.random.Generator) -> None:
    start, corners = make_problem(2)
    layout = Layout(3, 2, freedom)
    x = 0.01 * rng.normal(size=layout.size)
    full = approx_fprime(x, lambda v: find_residuals(_move(start, layout, v), corners, freedom), 1e-6)
    ours = find_jacobian(start, layout, corners, freedom, x).toarray()
    assert np.abs(full - ours).max() < 1e-3 * np.abs(full).max()
    assert (np.count_nonzero(ours, axis=1) <= 6 + 6 + 1 + 9).all()


def test_elimination_makes_the_columns_orthonormal_and_its_transpose_is_one(rng: np.random.Generator) -> None:
    start, corners = make_problem(8)
    layout = Layout(3, 8, Freedom())
    J = find_jacobian(start, layout, corners, Freedom(), np.zeros(layout.size))
    scale = EliminatedScale(J, layout.places)
    composed = scale.compose(J)
    columns = np.column_stack([composed.matvec(unit) for unit in np.eye(layout.size)])
    is_seen = np.abs(J.toarray()).max(axis=0) > 0  # what nothing depends on stays where it is
    assert is_seen.mean() > 0.8
    assert np.abs(columns.T @ columns - np.diag(is_seen.astype(float))).max() < 0.1
    x, y = rng.normal(size=(2, layout.size))
    assert scale.apply(y) @ x == pytest.approx(y @ scale.apply_transposed(x))


def test_from_a_wrong_start_the_true_cameras_and_boards_come_back(rng: np.random.Generator) -> None:
    truth, corners = make_problem(12)

    def shake(T: np.ndarray) -> np.ndarray:
        return np.array([exp(0.02 * rng.normal(size=6)) @ own for own in T])

    start = replace(truth, T_camera_world=shake(truth.T_camera_world), T_world_board=shake(truth.T_world_board))
    start.T_camera_world[0] = truth.T_camera_world[0]
    before = np.sqrt(np.mean(start.residuals(corners) ** 2))
    found = adjust(start, corners, Freedom(lenses=False, offsets=False))
    assert before > 10 and np.sqrt(np.mean(found.residuals(corners) ** 2)) < 0.02
    assert np.abs(found.T_camera_world - truth.T_camera_world).max() < 1e-4


def test_one_corner_in_twenty_being_far_off_moves_the_cameras_little(rng: np.random.Generator) -> None:
    truth, corners = make_problem(12)
    wrong = corners.pixels.copy()
    wrong[::20] += 15.0
    found = adjust(truth, replace(corners, pixels=wrong), Freedom(lenses=False, offsets=False))
    centres = [np.linalg.inv(T)[:3, 3] for T in (*found.T_camera_world, *truth.T_camera_world)]
    assert max(np.linalg.norm(centres[k] - centres[k + 3]) for k in range(3)) < 0.001


def test_a_time_offset_comes_back_from_the_motion_in_the_pictures() -> None:
    truth, corners = make_problem(12)
    late = replace(corners, pixels=corners.pixels - 0.004 * corners.velocity * (corners.camera == 1)[:, None])
    found = adjust(truth, late, Freedom(lenses=False))
    assert np.abs(found.offsets - [0.0, 0.004, 0.0]).max() < 0.0002
