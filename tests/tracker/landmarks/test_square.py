"""Squares of an image, and the way back from their crops."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracker.landmarks.square import Square, angle_of

ANGLES = st.floats(-np.pi, np.pi)
PLACES = st.floats(-200.0, 200.0)


@given(ANGLES, PLACES, PLACES, st.floats(20.0, 300.0))
def test_the_middle_of_a_crop_is_the_middle_of_its_square(angle: float, x: float, y: float, size: float) -> None:
    square = Square(np.array([x, y]), size, angle)
    np.testing.assert_allclose(square.to_image(np.array([[111.5, 111.5]]), 224), [[x, y]], atol=1e-9)


@pytest.mark.parametrize("angle", [0.0, 0.7, np.pi / 2, -2.5])
def test_a_mark_lies_in_the_crop_where_the_way_back_says(angle: float) -> None:
    image = np.zeros((240, 320, 3), dtype=np.uint8)
    cv2.circle(image, (150, 110), 4, (255, 255, 255), -1)
    square = Square(np.array([160.0, 120.0]), 120.0, angle)
    crop = square.cut(image, 224)[0, 0].astype(np.float64)
    rows, columns = np.mgrid[:224, :224]
    middle = np.array([[(columns * crop).sum(), (rows * crop).sum()]]) / crop.sum()
    np.testing.assert_allclose(square.to_image(middle, 224), [[150.0, 110.0]], atol=0.1)


@given(ANGLES)
def test_a_square_around_points_turns_with_them(angle: float) -> None:
    points = np.array([[10.0, 40.0], [30.0, 5.0], [22.0, 33.0]])
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    upright = Square.around(points, 0.0, 0.1, 2.0)
    turned = Square.around(points @ turn.T, angle, 0.1, 2.0)
    np.testing.assert_allclose(turned.center, turn @ upright.center, atol=1e-9)
    assert turned.size == pytest.approx(upright.size)


def test_the_way_from_wrist_to_fingers_is_up() -> None:
    wrist = np.array([5.0, 5.0])
    assert angle_of(wrist, np.array([5.0, -5.0])) == pytest.approx(0.0)
    assert angle_of(wrist, np.array([15.0, 5.0])) == pytest.approx(np.pi / 2)
