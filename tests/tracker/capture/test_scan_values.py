"""Values of a scan file: points taken with what belongs to them, colours of any kind as bytes."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tracker.capture.scan_values import RawScan, to_bytes_of_color

POINTS = np.arange(12.0).reshape(4, 3)
NORMALS = -POINTS
COLORS = np.arange(12, dtype=np.uint8).reshape(4, 3)
FACES = np.array([[0, 1, 2]])


@pytest.mark.parametrize("kept", [np.array([True, False, False, True]), np.array([3, 0]), np.zeros(0, dtype=int)])
def test_points_are_taken_with_their_normals_and_colours_in_the_order_asked_for(kept: np.ndarray) -> None:
    taken = RawScan(POINTS, FACES, NORMALS, COLORS).take(kept, None)
    assert taken.faces is None and taken.normals is not None and taken.colors is not None
    assert np.array_equal(taken.points, POINTS[kept])
    assert np.array_equal(taken.normals, -taken.points) and np.array_equal(taken.colors, taken.points)


def test_what_is_not_there_is_not_taken_and_triangles_are_those_that_were_given() -> None:
    taken = RawScan(POINTS).take(np.array([1, 2, 3]), FACES)
    assert taken.normals is None and taken.colors is None and taken.faces is FACES


@settings(max_examples=40)
@given(st.lists(st.integers(0, 255), min_size=3, max_size=3))
def test_a_byte_is_the_same_as_a_share_of_one_and_as_the_upper_half_of_16_bits(color: list[int]) -> None:
    values = np.array([color])
    assert to_bytes_of_color(values.astype(np.uint8)).tolist() == [color]
    assert to_bytes_of_color(values.astype(np.int64)).tolist() == [color]
    assert to_bytes_of_color(values / 255.0).tolist() == [color]
    assert to_bytes_of_color((257 * values).astype(np.uint16)).tolist() == [color]


@pytest.mark.parametrize(
    ("colors", "expected"),
    [
        (np.array([[0.0, 0.5, 1.0]]), [0, 128, 255]),
        (np.array([[0.0, 128.4, 255.0]]), [0, 128, 255]),
        (np.array([[-1.0, 300.0, 2.0]]), [0, 255, 2]),
        (np.array([[np.nan, np.inf, 0.2]]), [0, 0, 51]),
        (np.array([[-5, 256, 99999]]), [0, 255, 255]),
        (np.array([[-5, 255, 256]], dtype=np.int16), [0, 0, 1]),
    ],
)
def test_odd_colours_are_brought_into_range(colors: np.ndarray, expected: list[int]) -> None:
    found = to_bytes_of_color(colors)
    assert found.dtype == np.uint8 and found.tolist() == [expected]


@pytest.mark.parametrize("kind", [np.float32, np.uint16, np.uint8])
def test_no_colours_are_no_colours(kind: type) -> None:
    assert to_bytes_of_color(np.zeros((0, 3), kind)).shape == (0, 3)
