"""The wrench test agrees with what one knows of grasps."""

from itertools import pairwise

import numpy as np
import pytest

from tracker.physics.wrench import build_wrenches, find_imbalance

DOWN = np.array([0.0, 1.0, 0.0])
R = 0.02


def imbalance(normals, friction=0.8, points=None):
    inward = -np.array(normals, dtype=np.float64).reshape(-1, 3)
    points = -R * inward if points is None else np.array(points, dtype=np.float64)
    return find_imbalance(build_wrenches(points, inward, friction, np.zeros(3), R), DOWN)


def test_nothing_carries_nothing():
    assert imbalance(np.zeros((0, 3))) == 1.0


def test_a_support_from_below_carries_all_even_without_friction():
    assert imbalance([DOWN], friction=0.0) == pytest.approx(0.0, abs=1e-9)


def test_a_push_from_above_carries_nothing():
    assert imbalance([-DOWN]) > 0.99


def test_two_opposing_contacts_carry_by_friction_only():
    pinch = [[1, 0, 0], [-1, 0, 0]]
    assert imbalance(pinch) < 1e-9
    assert imbalance(pinch, friction=0.0) > 0.99


def test_one_contact_from_the_side_cannot_carry():
    assert imbalance([[1, 0, 0]]) > 0.3


def test_a_support_beside_the_centroid_lets_the_object_tip():
    assert imbalance([DOWN], friction=0.0, points=[[0.5 * R, R, 0.0]]) > 0.1


def test_more_contacts_never_carry_less(rng):
    for _ in range(30):
        normals = rng.normal(size=(4, 3))
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        shares = [imbalance(normals[:count]) for count in range(1, 5)]
        assert all(later <= before + 1e-9 for before, later in pairwise(shares))
