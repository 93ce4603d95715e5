"""The largest plane is found among other points, seen from where the camera is."""

import numpy as np
import pytest

from tracker.physics import find_plane

EYE = np.zeros(3)


def table(rng, count=2000, noise=0.001):
    """Points (count, 3) of a table 0.6 m before the eye and below it, seen from above; its normal; clutter beside."""
    normal = np.array([0.1, -0.9, -0.4]) / np.linalg.norm([0.1, -0.9, -0.4])
    along = np.linalg.svd(normal[None])[2][1:]
    flat = rng.uniform(-0.3, 0.3, size=(count, 2)) @ along
    points = np.array([0.0, 0.15, 0.6]) + flat + rng.normal(scale=noise, size=(count, 1)) * normal
    clutter = rng.uniform([-0.3, -0.3, 0.3], [0.3, 0.1, 0.6], size=(count, 3))
    return points, normal, clutter


def test_a_table_is_found_in_clutter_with_its_normal_towards_the_eye(rng):
    points, normal, clutter = table(rng)
    found = find_plane(np.concatenate([clutter, points]), EYE, 1000)
    assert found is not None
    assert np.dot(found.normal, normal) > np.cos(np.deg2rad(0.5))
    assert abs(np.dot(points.mean(axis=0) - np.array(found.point), normal)) < 0.001
    assert find_plane(np.concatenate([clutter, points]), EYE, 1000) == found, "the same again"
    away = find_plane(np.concatenate([clutter, points]), points.mean(axis=0) - normal, 1000)
    assert away is not None and np.dot(away.normal, normal) < -0.99


@pytest.mark.parametrize("points", [np.zeros((0, 3)), np.zeros((5000, 3)), np.outer(np.arange(5000.0), [1, 1, 1])])
def test_no_points_or_points_that_make_no_plane_give_none(points):
    assert find_plane(points, EYE) is None


def test_too_few_points_on_a_plane_give_none(rng):
    points, _, clutter = table(rng)
    assert find_plane(np.concatenate([clutter, points]), EYE, 3500) is None
    assert find_plane(clutter, EYE, 500) is None
