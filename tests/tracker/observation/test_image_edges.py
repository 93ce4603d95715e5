"""Edges of colour images, by direction."""

from __future__ import annotations

import numpy as np
import pytest

from tracker.capture.camera import Camera
from tracker.observation.image_edges import DIRECTIONS, find_image_edges

K = np.array([[300.0, 0.0, 80.0], [0.0, 300.0, 60.0], [0.0, 0.0, 1.0]])
CAMERA = Camera("cam0", 160, 120, K)


def bright_square() -> np.ndarray:
    image = np.full((120, 160, 3), 20, dtype=np.uint8)
    image[40:80, 60:100] = 220
    return image


def test_the_nearest_edge_is_one_of_the_direction_that_is_asked_for():
    found = find_image_edges(bright_square(), CAMERA, np.array([[50.0, 30.0], [110.0, 90.0]]), 10.0)
    left, top = (K[:2, 2] - found.K[:2, 2]).astype(int)
    across, down = found.nearest[0], found.nearest[DIRECTIONS // 2]
    row, column = 60 - top, 70 - left  # inside, nearer to the left side than to the right, 20 px from top and bottom
    assert across[row, column] == pytest.approx((row, 59.5 - left), abs=0.1)
    row = 50 - top
    assert down[row, column] == pytest.approx((39.5 - top, column), abs=0.1)


def test_a_plain_image_has_no_edges_and_what_is_out_of_sight_no_part():
    plain = np.full((120, 160, 3), 128, dtype=np.uint8)
    assert np.isnan(find_image_edges(plain, CAMERA, np.array([[80.0, 60.0]]), 20.0).nearest).all()
    assert find_image_edges(plain, CAMERA, np.array([[500.0, 60.0], [520.0, 70.0]]), 20.0) is None
    assert find_image_edges(plain, CAMERA, np.full((1, 2), np.nan), 20.0) is None
