"""The cost that the swarm minimises before colour cameras, on a drawn hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.baselines.discrepancy import CUT, SILHOUETTE_WEIGHT
from benchmarks.baselines.joint_rays import JointRays
from benchmarks.baselines.view_discrepancy import ViewDiscrepancy
from tests.benchmarks.baselines.scenes import seen_hand
from tracker.fitting.view_hands import ViewHands
from tracker.model.scene import Scene

NO_JOINTS = ViewHands((), ())


@pytest.fixture(scope="module")
def hand():
    return seen_hand()


def cost_of(hand, views=None) -> ViewDiscrepancy:
    return ViewDiscrepancy(hand.scene, views or hand.maps(hand.pose), JointRays.of(hand.scene, NO_JOINTS, ("right",)))


def test_the_true_pose_costs_nothing_and_one_out_of_sight_most(hand):
    cost = cost_of(hand)
    assert cost(hand.pose) == 0.0
    away = hand.pose.copy()
    away[0] += 5.0
    assert cost(away) == CUT + SILHOUETTE_WEIGHT


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_it_grows_with_displacement_along_every_axis(hand, axis):
    cost = cost_of(hand)
    costs = []
    for far in (0.0, 0.005, 0.01, 0.02, 0.04):
        moved = hand.pose.copy()
        moved[axis] += far
        costs.append(cost(moved))
    assert np.all(np.diff(costs) > 0.5)


def test_it_grows_as_a_finger_bends(hand):
    cost = cost_of(hand)
    flexion = 6 + int(np.argmax(hand.scene.models[0].skeleton.upper))
    costs = []
    for angle in (0.0, 0.3, 0.6, 0.9):
        bent = hand.pose.copy()
        bent[flexion] += angle
        costs.append(cost(bent))
    assert np.all(np.diff(costs) > 0.0)


def test_where_the_silhouette_is_right_the_distance_of_edges_is_all_it_costs(hand):
    views = hand.maps(hand.pose)
    nowhere = [replace(view, edge_mm=np.full_like(view.edge_mm, 30.0)) for view in views]
    step = views[0].step_mm
    assert cost_of(hand, nowhere)(hand.pose) == pytest.approx(30.0 - 0.5 * step)


def test_an_object_is_no_hand_and_skin_where_it_is_drawn_counts_against_the_pose(hand):
    as_object = Scene((replace(hand.scene.models[0], hand=None),))
    cost = ViewDiscrepancy(as_object, hand.maps(hand.pose), JointRays.of(as_object, NO_JOINTS, ("ball",)))
    assert cost(hand.pose) == SILHOUETTE_WEIGHT


def test_a_hand_drawn_where_no_skin_is_seen_costs_the_whole_silhouette(hand):
    empty = [replace(view, is_skin=np.zeros_like(view.is_skin)) for view in hand.maps(hand.pose)]
    assert cost_of(hand, empty)(hand.pose) == SILHOUETTE_WEIGHT
