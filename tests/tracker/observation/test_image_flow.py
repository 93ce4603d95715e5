"""Optical flow of a part of an image: right where it is known, unknown where it cannot be."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from tracker.capture.camera import Camera
from tracker.observation.image_flow import find_image_flow

K = np.array([[300.0, 0.0, 160.0], [0.0, 300.0, 120.0], [0.0, 0.0, 1.0]])
CAMERA = Camera("cam0", 320, 240, K)
CORNERS = np.array([[60.0, 40.0], [260.0, 200.0]])
SHIFT = np.array([3.25, -1.5])


@pytest.fixture(scope="module")
def pair() -> tuple[np.ndarray, np.ndarray]:
    """A spotted wall, and the same moved by SHIFT, px."""
    rng = np.random.default_rng(0)
    wall = cv2.GaussianBlur(rng.uniform(0, 255, (240, 320)), (0, 0), 2.0)
    wall = 128 + 6.0 * (wall - wall.mean())
    moved = cv2.warpAffine(wall, np.array([[1.0, 0.0, SHIFT[0]], [0.0, 1.0, SHIFT[1]]]), (320, 240))
    first, second = (np.repeat(np.clip(each, 0, 255).astype(np.uint8)[..., None], 3, axis=2) for each in (wall, moved))
    return first, second


def test_it_says_where_pixels_are_now(pair):
    flow = find_image_flow(*pair, CAMERA, CORNERS, 10.0)
    left, top = (K[:2, 2] - flow.K[:2, 2]).astype(int)
    assert (left, top) == (50, 30)
    rows, columns = np.indices(flow.now.shape[:2])
    moved = flow.now - np.dstack([columns, rows])
    inner = moved[20:-20, 20:-20].reshape(-1, 2)
    known = np.isfinite(inner).all(axis=1)
    assert known.mean() > 0.95
    np.testing.assert_allclose(np.median(inner[known], axis=0), SHIFT, atol=0.2)


def test_covered_pixels_and_pixels_that_are_something_else_now_have_none(pair):
    covered = np.zeros((240, 320), dtype=bool)
    covered[100:140, 100:140] = True
    flow = find_image_flow(*pair, CAMERA, CORNERS, 10.0, covered)
    assert np.isnan(flow.now[70:110, 50:90]).all()
    other = pair[1].copy()
    other[80:160, 120:200] = other[150:70:-1, 260:180:-1]
    flow = find_image_flow(pair[0], other, CAMERA, CORNERS, 10.0)
    assert np.isnan(flow.now[65:115, 85:135, 0]).mean() > 0.5


def test_what_is_out_of_sight_has_no_part(pair):
    assert find_image_flow(*pair, CAMERA, np.array([[900.0, 50.0], [950.0, 60.0]]), 10.0) is None
