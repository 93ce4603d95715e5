"""A part of an image is where its points are, and an ideal lens's K holds in it to the pixel."""

from __future__ import annotations

import cv2
import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from tracker.capture.camera import Camera
from tracker.observation.image_part import SMALLEST, frame_points

K = np.array([[150.0, 0.0, 80.0], [0.0, 150.0, 60.0], [0.0, 0.0, 1.0]])
STRAIGHT = Camera("cam0", 160, 120, K)
BENT = Camera("cam0", 160, 120, K, np.array([-0.25, 0.06, 0.001, -0.001, 0.0]))
points = arrays(np.float64, st.tuples(st.integers(1, 6), st.just(2)), elements=st.floats(-300.0, 400.0))


@given(points, st.floats(0.0, 40.0))
def test_a_part_lies_in_the_image_and_around_all_points_that_do(points, margin) -> None:
    part = frame_points(STRAIGHT, points, margin)
    low = np.maximum(points.min(axis=0) - margin, 0.0)
    high = np.minimum(points.max(axis=0) + margin, [159.0, 119.0])
    if part is None:
        assert (high - low < SMALLEST).any()
        return
    assert min(part.width, part.height) >= SMALLEST
    last = part.low + np.array([part.width, part.height]) - 1
    assert (part.low >= 0).all() and (last <= [159, 119]).all()
    assert (part.low <= low).all() and (last >= np.floor(high)).all()


def test_points_that_are_not_known_do_not_count_and_none_make_no_part() -> None:
    known = np.array([[50.0, 40.0], [90.0, 80.0]])
    part, same = (frame_points(STRAIGHT, p, 5.0) for p in (known, np.vstack([known, [[np.nan, 3.0]]])))
    assert part is not None and same is not None and np.array_equal(part.low, same.low)
    assert frame_points(STRAIGHT, np.full((3, 2), np.nan), 5.0) is None


def test_a_part_of_a_straight_lens_is_cut_out_unchanged(rng) -> None:
    image = rng.integers(0, 256, (120, 160, 3), dtype=np.uint8)
    part = frame_points(STRAIGHT, np.array([[50.0, 40.0], [90.0, 80.0]]), 0.0)
    assert part is not None and np.array_equal(part.cut(image), image[40:81, 50:91])


def test_a_part_of_a_bent_lens_shows_a_point_where_its_own_straight_camera_projects_it() -> None:
    point = np.array([0.13, -0.09, 0.5])
    (seen,), _ = cv2.projectPoints(point[None], np.zeros(3), np.zeros(3), K, BENT.distortion)
    rows, columns = np.mgrid[:120, :160]
    spot = np.exp(-0.5 * ((columns - seen[0, 0]) ** 2 + (rows - seen[0, 1]) ** 2) / 2.0**2)
    part = frame_points(BENT, (K @ point)[None, :2] / point[2], 20.0)
    assert part is not None
    cut = part.cut((255 * spot).astype(np.uint8)).astype(np.float64)
    rows, columns = np.mgrid[: part.height, : part.width]
    middle = np.array([(cut * columns).sum(), (cut * rows).sum()]) / cut.sum()
    expected = (part.K @ point)[:2] / point[2]
    assert np.abs(middle - expected).max() < 0.1, "px"
    assert np.abs(seen[0] - (K @ point)[:2] / point[2]).max() > 1.0, "the lens bends there"
