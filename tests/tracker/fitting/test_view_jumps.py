"""A joint told far from where it is expected is left out, unless its finger or another view bears it out."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tracker.search.test_place_in_views import joints, look_from, see
from tracker.fitting.view_jumps import find_jumps

__all__ = ["joints"]

CAMERAS = [look_from(angle) for angle in (0.0, 0.8)]
TIP, DIP, PIP = 8, 7, 6


@pytest.fixture
def told(joints, rng) -> list:
    """The hand as both views see it, a pixel off."""
    return [hands["right"] for hands in see(joints, CAMERAS, rng).hands]


def list_jumps(joints, told, fps: float = 25.0) -> list[tuple[int, int]]:
    return [
        (int(view), int(joint)) for view, joint in zip(*np.nonzero(find_jumps(joints, CAMERAS, told, fps)), strict=True)
    ]


def test_a_hand_that_is_where_it_is_expected_has_no_jumps(joints, told):
    assert list_jumps(joints, told) == []


def test_a_joint_told_far_off_by_one_view_is_a_jump_and_a_near_one_is_none(joints, told):
    told[1].points[TIP] += [70.0, 70.0]
    told[0].points[4] += [3.0, 3.0]
    assert list_jumps(joints, told) == [(1, TIP)]


def test_between_frames_that_are_far_apart_a_joint_may_go_far(joints, told):
    told[1].points[TIP] += [70.0, 70.0]
    assert list_jumps(joints, told, 4.5) == []


def test_a_wrong_ray_that_meets_one_that_is_as_expected_is_still_a_jump(joints, told):
    """It crosses the true ray elsewhere, by chance."""
    along = joints[TIP] - CAMERAS[0].T_world_camera[:3, 3]
    told[1].points[TIP] = CAMERAS[1].project((joints[TIP] + 0.2 * along)[None])[0]
    assert list_jumps(joints, told) == [(1, TIP)]


def test_a_joint_that_both_views_tell_elsewhere_in_one_place_moved(joints, told):
    there = (joints[TIP] + [0.04, 0.05, 0.03])[None]
    for camera, hand in zip(CAMERAS, told, strict=True):
        hand.points[TIP] = camera.project(there)[0]
    assert list_jumps(joints, told) == []


def test_a_finger_that_goes_one_way_in_one_view_moved(joints, told):
    told[0].points[[PIP, DIP, TIP]] += np.array([[45.0, 45.0], [60.0, 60.0], [75.0, 75.0]])
    assert list_jumps(joints, told) == []


def test_a_hand_that_moved_as_a_whole_has_no_jumps(joints, told):
    assert list_jumps(joints + np.array([0.08, 0.02, 0.0]), told) == []


def test_views_that_tell_nothing_have_no_jumps(joints, told):
    told[0].points[:] = np.nan
    assert not find_jumps(joints, CAMERAS, [told[0], None], 25.0).any()
