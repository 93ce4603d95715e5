"""Numbers of somebody's calibration become a camera, or an error that says which of them is none."""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from tracker.capture.video_calibration import make_camera, to_array
from tracker.errors import CalibrationError

K = [[30, 0, 16], [0, 31, 12], [0, 0, 1]]
ARRAYS = hnp.arrays(np.float64, hnp.array_shapes(max_dims=3, max_side=4), elements=st.floats(-1e9, 1e9))


@given(ARRAYS)
def test_opencvs_two_ways_to_write_an_array_are_that_array(array: np.ndarray) -> None:
    np.testing.assert_array_equal(to_array(array.tolist(), "K"), array)
    sizes = {"sizes": list(array.shape), "data": array.ravel().tolist()}
    np.testing.assert_array_equal(to_array(sizes, "K"), array)
    rows = {"rows": len(array), "cols": array.size // len(array), "dt": "d", "data": array.tolist()}
    np.testing.assert_array_equal(to_array(rows, "K"), array.reshape(len(array), -1))


@pytest.mark.parametrize(
    ("value", "told"),
    [
        ({"rows": 2, "cols": 2, "data": [1, 2, 3]}, r"K: says \[2, 2\] numbers and has 3"),
        ({"rows": True, "cols": 3, "data": [1, 2, 3]}, "K: says"),
        ({"sizes": [], "data": 1}, "K: says"),
        ({"sizes": [-1, -3], "data": [1, 2, 3]}, "K: says"),
        ({"rows": 3, "data": [1, 2, 3]}, "K: is not an array of numbers"),
        ("3", "K: is not an array of numbers"),
        ([True], "K: is not an array of numbers"),
        ([[1, 2], [3]], "K: is not an array of numbers"),
        ([10**400], "K: is not an array of numbers"),
        (np.zeros(10_001), "K: is not an array of numbers"),
        ([1, float("nan")], "K: holds NaN or infinity"),
    ],
)
def test_what_is_no_array_of_numbers_is_refused_by_its_name(value: Any, told: str) -> None:
    with pytest.raises(CalibrationError, match=told):
        to_array(value, "K")


@given(hnp.arrays(np.float64, 3, elements=st.floats(-3, 3)), hnp.arrays(np.float64, 3, elements=st.floats(-9, 9)))
def test_a_pose_takes_a_point_of_the_camera_to_where_the_calibration_has_it(rvec: np.ndarray, t: np.ndarray) -> None:
    camera = make_camera("c", "file", {"K": K, "R": rvec.tolist(), "t": t.tolist()})
    R = cv2.Rodrigues(rvec)[0]
    T_world_camera = camera.find_pose(0.001)
    world = np.array([1.0, 2.0, 3.0])  # in the calibration's unit
    np.testing.assert_allclose((T_world_camera @ [*(R @ world + t) * 0.001, 1.0])[:3], world * 0.001, atol=1e-9)


@pytest.mark.parametrize(
    ("values", "told"),
    [
        ({}, "needed a camera"),
        ({"K": [1, 2, 3]}, r"K has shape \(3,\)"),
        ({"K": K, "R": [[1, 0], [0, 1]]}, r"R has shape \(2, 2\)"),
        ({"K": K, "R": [[1, 0, 0], [0, 1, 0], [0, 0, 2]]}, "R is not a rotation"),
        ({"K": K, "R": [[1, 0, 0], [0, 1, 0], [0, 0, -1]]}, "determinant -1"),
        ({"K": K, "t": [1, 2]}, "t has 2 numbers"),
        ({"K": K, "size": [0, 5]}, "the image size is"),
        ({"K": K, "size": [5]}, "the image size is"),
    ],
)
def test_values_that_make_no_camera_are_refused(values: dict[str, Any], told: str) -> None:
    with pytest.raises(CalibrationError, match=told):
        make_camera("c", "file", values)
