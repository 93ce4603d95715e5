"""Rays of a joint that miss where most rays meet are not believed."""

from __future__ import annotations

import numpy as np
import pytest

from tracker.fitting.ray_agreement import MEETS, find_believed


@pytest.fixture
def rays(rng) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Six cameras around ten joints: origins (6, 3), joints (10, 3) and directions (10, 6, 3)."""
    angles = np.linspace(0.0, 5.0, 6)
    origins = np.column_stack([np.cos(angles), np.sin(angles), np.linspace(-0.3, 0.4, 6)])
    joints = rng.uniform(-0.05, 0.05, (10, 3))
    return origins, joints, aim(origins, joints[:, None] + rng.normal(0.0, 0.002, (10, 6, 3)))


def aim(origins: np.ndarray, places: np.ndarray) -> np.ndarray:
    directions = places - origins
    return directions / np.linalg.norm(directions, axis=-1, keepdims=True)


def test_rays_that_meet_are_all_believed(rays):
    origins, _, directions = rays
    assert np.all(find_believed(origins, directions))


def test_one_or_two_false_rays_of_six_are_found(rays):
    origins, joints, directions = rays
    up = np.array([0.0, 0.0, 0.06])
    directions[3, 2] = aim(origins[2], joints[3] + up)
    directions[5, [0, 4]] = aim(origins[[0, 4]], joints[5] - up)
    believed, supported = find_believed(origins, directions)
    np.testing.assert_array_equal(supported, believed)
    assert np.argwhere(~believed).tolist() == [[3, 2], [5, 0], [5, 4]]
    assert MEETS < 0.06


def test_of_rays_of_which_no_three_meet_none_is_doubted(rays):
    origins, joints, directions = rays
    directions[:, 3:] = np.nan
    directions[2, 1] = aim(origins[1], joints[2] + np.array([0.0, 0.0, 0.06]))
    assert find_believed(origins, directions)[0][2, :3].all()
    assert find_believed(origins[:2], directions[:, :2])[0].all()


def test_nothing_seen_is_nothing_doubted(rays):
    origins, _, directions = rays
    assert find_believed(origins, np.full_like(directions, np.nan))[0].all()
    assert find_believed(origins, np.zeros((0, 6, 3)))[0].shape == (0, 6)
