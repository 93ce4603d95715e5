"""Detected joints as rays that poses are measured against."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.baselines.discrepancy import CUT
from benchmarks.baselines.joint_rays import JointRays
from tests.benchmarks.baselines.scenes import seen_hand
from tracker.fitting.view_hands import ViewHands
from tracker.landmarks import DetectedHand


@pytest.fixture(scope="module")
def hand():
    return seen_hand()


def detect(hand, pose: np.ndarray) -> ViewHands:
    """The joints of a pose as all cameras show them; the wrist is seen by none."""
    hands = []
    for camera in hand.cameras:
        points = camera.project(hand.scene.pose_at(pose).landmarks(0))
        points[0] = np.nan
        hands.append({"right": DetectedHand(points, np.zeros((21, 3)), 1.0, 1.0)})
    return ViewHands(hand.cameras, tuple(hands))


def test_the_joints_that_were_seen_lie_on_their_rays_and_leave_them_as_they_move(hand):
    rays = JointRays.of(hand.scene, detect(hand, hand.pose), ("right",))
    assert len(rays.ids) == 20 * len(hand.cameras)
    vertices = hand.scene.pose_at(hand.pose).vertices
    assert rays.measure(vertices) == pytest.approx(0.0, abs=1e-6)
    first = rays.origins[:, 0] == hand.cameras[0].T_world_camera[0, 3]
    alone = JointRays(rays.ids[first], rays.origins[first], rays.directions[first])
    assert 3.0 < alone.measure(vertices + np.array([0.004, 0.0, 0.0])) <= 4.0  # mm, across the first camera's rays
    assert alone.measure(vertices + np.array([0.0, 0.0, 0.004])) < 1.5  # along them


def test_a_false_joint_counts_no_more_than_the_cut_and_none_count_nothing(hand):
    rays = JointRays.of(hand.scene, detect(hand, hand.pose), ("right",))
    vertices = hand.scene.pose_at(hand.pose).vertices
    assert rays.measure(vertices + 5.0) == pytest.approx(CUT)
    nothing = JointRays.of(hand.scene, ViewHands((), ()), ("right",))
    assert nothing.measure(vertices) == 0.0
