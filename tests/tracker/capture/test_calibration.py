"""Which intrinsics and poses from outside are those of a possible camera."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from tracker.capture.calibration import (
    DISTORTION_SIZES,
    check_distortion,
    check_image_size,
    check_intrinsics,
    check_rigid,
    nearest_rotation,
)
from tracker.errors import CalibrationError
from tracker.geometry.se3 import exp

K = np.array([[600.0, 0, 320], [0, 600, 240], [0, 0, 1]])


def changed(array: np.ndarray, place: tuple[int, int], value: float) -> np.ndarray:
    result = array.copy()
    result[place] = value
    return result


@pytest.mark.parametrize(
    ("width", "height", "is_one"), [(8, 8, 1), (7, 8, 0), (8000, 8000, 1), (8001, 8000, 0), (16385, 8, 0)]
)
def test_images_are_neither_tiny_nor_beyond_64_million_pixels(width: int, height: int, is_one: int) -> None:
    if is_one:
        check_image_size("cam0", width, height)
    else:
        with pytest.raises(CalibrationError, match=f"cam0: image size {width}x{height}"):
            check_image_size("cam0", width, height)


@pytest.mark.parametrize(
    ("K", "told"),
    [
        (np.eye(4), "3 rows of 3"),
        (changed(K, (0, 0), np.nan), "3 rows of 3 finite"),
        (changed(K, (2, 2), 2.0), "needed \\[\\[fx, 0, cx\\]"),
        (K.T, "needed \\[\\[fx, 0, cx\\]"),
        (changed(K, (0, 1), 0.5), "skew 0.5"),
        (changed(K, (0, 0), 31.9), "fx is 31.9 px"),
        (changed(K, (1, 1), 0.6), "fy is 0.6 px .*Is it in pixels"),
        (changed(K, (0, 0), 64_001.0), "fx is 64001"),
        (changed(K, (0, 2), 1601.0), "far outside"),
        (changed(K, (1, 2), -721.0), "far outside"),
    ],
)
def test_intrinsics_that_no_pinhole_has_are_refused(K: np.ndarray, told: str) -> None:
    with pytest.raises(CalibrationError, match=told):
        check_intrinsics("cam0", K, 640, 480)


def test_usual_intrinsics_pass() -> None:
    check_intrinsics("cam0", K, 640, 480)


@given(st.integers(0, 15))
def test_distortion_has_as_many_coefficients_as_one_of_opencvs_models(count: int) -> None:
    if count in DISTORTION_SIZES:
        check_distortion("cam0", np.zeros(count))
    else:
        with pytest.raises(CalibrationError, match=f"{count} distortion coefficients; OpenCV has 0, 4, 5, 8, 12 or 14"):
            check_distortion("cam0", np.zeros(count))


@pytest.mark.parametrize("value", [np.inf, 1e5])
def test_distortion_is_finite_and_of_a_lens(value: float) -> None:
    with pytest.raises(CalibrationError, match="finite and below"):
        check_distortion("cam0", np.array([0, 0, 0, value]))


@given(hnp.arrays(np.float64, 6, elements=st.floats(-3, 3)))
def test_every_motion_is_rigid_and_its_mirror_image_is_not(twist: np.ndarray) -> None:
    T = exp(twist)
    check_rigid("cam0", T)
    with pytest.raises(CalibrationError, match="mirrors"):
        check_rigid("cam0", T @ np.diag([1.0, 1.0, -1.0, 1.0]))


@pytest.mark.parametrize(
    ("T", "told"),
    [
        (np.eye(3), "4 rows of 4"),
        (changed(np.eye(4), (3, 0), 0.1), "last row"),
        (np.diag([3.0, 3.0, 3.0, 1.0]), "it scales"),
        (changed(np.eye(4), (0, 1), 0.01), "off by 0.01"),
        (changed(np.eye(4), (0, 3), 1500.0), "translation is 1500 m; is it in metres"),
    ],
)
def test_what_is_no_motion_is_refused(T: Any, told: str) -> None:
    with pytest.raises(CalibrationError, match=told):
        check_rigid("cam0", T)


@given(
    hnp.arrays(np.float64, 6, elements=st.floats(-3, 3)),
    hnp.arrays(np.float64, (3, 3), elements=st.floats(-1e-3, 1e-3)),
)
def test_the_nearest_rotation_is_a_rotation_and_nearer_than_any_beside_it(twist: np.ndarray, error: np.ndarray) -> None:
    R = exp(twist)[:3, :3]
    found = nearest_rotation(R + error)
    np.testing.assert_allclose(found.T @ found, np.eye(3), atol=1e-12)
    assert np.linalg.det(found) > 0 and np.linalg.norm(found - R - error) <= np.linalg.norm(error) + 1e-12
