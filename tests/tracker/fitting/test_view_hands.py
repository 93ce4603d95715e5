"""Joints seen in several views: false ones among many, and which of them pull from afar."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tracker.search.test_place_in_views import SCENE, joints, look_from, see
from tracker.fitting.view_hands import REACH, ViewHands

__all__ = ["joints"]

ANGLES = (-1.2, -0.6, 0.0, 0.6, 1.2)


@pytest.fixture
def seen(joints: np.ndarray, rng: np.random.Generator) -> ViewHands:
    return see(joints, [look_from(angle) for angle in ANGLES], rng)


def test_a_joint_that_one_of_five_views_tells_wrongly_has_four_rays(seen):
    assert len(seen.rays(SCENE, 0, "right").ids) == 21 * 5
    seen.hands[2]["right"].points[8] += 100.0
    ids = seen.rays(SCENE, 0, "right").ids - SCENE.landmark_slices[0].start
    assert np.bincount(ids).tolist() == [5] * 8 + [4] + [5] * 12


def test_a_joint_that_two_views_see_pulls_only_when_it_is_near(seen):
    for hands in seen.hands[:3]:
        hands["right"].points[4] = np.nan
    near = seen.rays(SCENE, 0, "right").ids - SCENE.landmark_slices[0].start
    far = seen.rays(SCENE, 0, "right", 4.0 * REACH).ids - SCENE.landmark_slices[0].start
    assert np.count_nonzero(near == 4) == 2
    assert np.count_nonzero(far == 4) == 0
    assert len(far) == len(near) - 2


def test_a_joint_that_a_single_view_of_four_sees_pulls_only_when_it_is_near_however_few_joints_are_sure(joints, rng):
    seen = see(joints, [look_from(angle) for angle in ANGLES[:4]], rng)
    for hands in seen.hands[:2]:
        hands["right"].points[:] = np.nan  # no joint has three rays
    seen.hands[2]["right"].points[8] = np.nan
    near = seen.rays(SCENE, 0, "right").ids - SCENE.landmark_slices[0].start
    far = seen.rays(SCENE, 0, "right", 4.0 * REACH).ids - SCENE.landmark_slices[0].start
    assert np.bincount(near).tolist() == [2] * 8 + [1] + [2] * 12
    assert np.bincount(far).tolist() == [2] * 8 + [0] + [2] * 12


def test_of_three_views_all_rays_count(joints, rng):
    seen = see(joints, [look_from(angle) for angle in ANGLES[1:4]], rng)
    seen.hands[1]["right"].points[8] += 100.0
    for reach in (REACH, 4.0 * REACH):
        assert len(seen.rays(SCENE, 0, "right", reach).ids) == 21 * 3
