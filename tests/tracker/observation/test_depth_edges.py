"""A discontinuity knows to which side the surface ends."""

import numpy as np
import pytest

from tracker.observation.depth_edges import find_depth_edges_into, find_fall

JUMP = 0.015


def step_image(angle: float) -> np.ndarray:
    """(41, 41) a half plane at 0.5 m before one at 0.6 m, which lies in the direction `angle`, rad from +x to +y."""
    rows, columns = np.indices((41, 41)) - 20
    beyond = np.cos(angle) * columns + np.sin(angle) * rows > 0.0
    return np.where(beyond, 0.6, 0.5).astype(np.float32)


@pytest.mark.parametrize("degrees", [0, 30, 90, 135, 180, 260])
def test_it_points_to_what_is_deeper_and_is_the_same_in_depth_and_in_its_inverse(degrees):
    angle = np.deg2rad(degrees)
    depth = step_image(angle)
    edges = np.zeros(depth.shape, dtype=np.uint8)
    find_depth_edges_into(edges, depth, (depth < 0.55).astype(np.uint8), JUMP)
    rows, columns = np.nonzero(edges[5:-5, 5:-5])
    assert len(rows) >= 25
    for row, column in zip(rows + 5, columns + 5, strict=True):
        fall = find_fall(depth, False, row, column, JUMP)
        assert np.dot(fall, [np.cos(angle), np.sin(angle)]) > np.cos(np.deg2rad(20))
        np.testing.assert_allclose(find_fall(1.0 / depth, True, row, column, JUMP), fall)


def test_nothing_counts_as_deeper_and_a_level_surface_has_no_direction():
    depth = step_image(0.0)
    depth[depth > 0.55] = 0.0
    assert find_fall(depth, False, 20, 20, JUMP) == (1.0, 0.0)
    assert find_fall(depth, False, 20, 5, JUMP) == (0.0, 0.0)
    assert find_fall(depth, False, 0, 0, JUMP) == (0.0, 0.0)
