"""Residuals are projected minus seen, whatever moves with what; boards and doubts of cameras come from them."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.tracker.calibration.filmed_board import BOARD, film, place_board
from tracker.calibration.arrangement import Arrangement, Corners
from tracker.calibration.board_places import find_board_places
from tracker.calibration.bundle import Freedom, Layout, find_jacobian
from tracker.calibration.camera_certainty import find_covariance, find_pixel_std
from tracker.calibration.moments import read_corners
from tracker.geometry.se3 import exp

FILMED = film(3, seconds=6.0, fps=10.0, spread=0.6)
TIMES = np.arange(8) * 0.4


def true_arrangement() -> Arrangement:
    distortion = np.zeros((3, 12))
    distortion[:, :5] = [camera.distortion for camera in FILMED.cameras]
    return Arrangement(
        np.array([camera.K for camera in FILMED.cameras]),
        distortion,
        np.array([camera.T_camera_world for camera in FILMED.cameras]),
        np.array([place_board(BOARD, time) for time in TIMES]),
        np.zeros(3),
        np.array([[camera.width, camera.height] for camera in FILMED.cameras], dtype=np.float64),
    )


TRUTH = true_arrangement()
CORNERS = read_corners(BOARD, FILMED.sight_all(noise_px=0.0), TIMES, np.zeros(3), np.ones(3, dtype=bool))


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


def test_each_board_is_placed_by_the_camera_whose_answer_suits_all_and_without_corners_not_at_all() -> None:
    places = find_board_places(BOARD, TRUTH, CORNERS, len(TIMES) + 1)
    assert np.abs(places[:-1] - TRUTH.T_world_board).max() < 1e-4 and np.isnan(places[-1]).all()
    spoilt = CORNERS.pixels.copy()
    own = CORNERS.camera == 1
    spoilt[own] += np.random.default_rng(0).normal(0, 8.0, (own.sum(), 2))
    other = find_board_places(BOARD, TRUTH, replace(CORNERS, pixels=spoilt), len(TIMES))
    assert np.abs(other - TRUTH.T_world_board).max() < 1e-3, "the sharp cameras decide"


def problem(freedom: Freedom) -> tuple[Layout, np.ndarray]:
    layout = Layout(3, len(TIMES), freedom)
    J = find_jacobian(TRUTH, layout, CORNERS, freedom, np.zeros(layout.size))
    return layout, J


def test_the_covariance_of_the_cameras_is_their_part_of_the_inverse_of_all_normal_equations() -> None:
    """[Triggs et al. 2000] section 9, by the whole dense matrix."""
    freedom = Freedom(lenses=False, offsets=False)
    layout, J = problem(freedom)
    dense = J.toarray()
    whole = np.linalg.inv(dense.T @ dense)[layout.places :, layout.places :]
    found = find_covariance(J, layout.places, 0.5)
    assert np.allclose(found, 0.25 * whole, rtol=1e-3, atol=1e-3 * np.abs(0.25 * whole).max())
    assert np.linalg.eigvalsh(found).min() > 0.0


def test_doubts_of_a_picture_grow_with_the_noise_and_the_first_camera_which_stands_still_has_none() -> None:
    freedom = Freedom(lenses=False, offsets=False)
    layout, J = problem(freedom)
    quiet, loud = (find_covariance(J, layout.places, sigma) for sigma in (0.2, 0.4))
    doubts = [find_pixel_std(TRUTH, number, freedom, quiet, 1.0) for number in range(3)]
    assert doubts[0] < 1e-3 < min(doubts[1:]) and max(doubts) < 2.0, "px"
    assert find_pixel_std(TRUTH, 1, freedom, loud, 1.0) == pytest.approx(2.0 * doubts[1])


def test_chosen_corners_keep_all_that_belongs_to_them() -> None:
    few = CORNERS.choose(CORNERS.camera == 2)
    assert set(few.camera) == {2} and len(few.points) == len(few.velocity) == (CORNERS.camera == 2).sum()
    assert isinstance(few, Corners) and np.array_equal(few.pixels, CORNERS.pixels[CORNERS.camera == 2])
