"""What the swarm is shown of a colour image."""

from __future__ import annotations

import numpy as np

from benchmarks.baselines.drawing import Drawing
from benchmarks.baselines.joint_rays import JointRays
from benchmarks.baselines.skin_view import see_skin
from benchmarks.baselines.view_discrepancy import ViewDiscrepancy
from tests.benchmarks.baselines.scenes import seen_hand
from tracker.fitting.view_hands import ViewHands


def test_skin_is_where_the_hand_is_drawn_and_edges_run_around_it():
    hand = seen_hand()
    vertices = hand.scene.pose_at(hand.pose).vertices
    for photograph in hand.photographs(hand.pose):
        view = see_skin(photograph, vertices, 64)
        assert view is not None
        assert 32 < max(view.is_skin.shape) <= 64
        drawing = Drawing(hand.scene, (view.canvas,))
        drawing.draw(vertices)
        is_drawn = drawing.face >= 0
        both, either = np.count_nonzero(is_drawn & view.is_skin), np.count_nonzero(is_drawn | view.is_skin)
        assert both > 0.93 * either
        outline = is_drawn[:, 1:] != is_drawn[:, :-1]
        nearer = np.minimum(view.edge_mm[:, 1:], view.edge_mm[:, :-1])
        assert np.quantile(nearer[outline], 0.9) <= view.step_mm


def test_before_an_image_the_true_pose_costs_next_to_nothing_and_a_displaced_one_more():
    hand = seen_hand()
    shown = [see_skin(view, hand.scene.pose_at(hand.pose).vertices, 64) for view in hand.photographs(hand.pose)]
    views = [view for view in shown if view is not None]
    cost = ViewDiscrepancy(hand.scene, views, JointRays.of(hand.scene, ViewHands((), ()), ("right",)))
    costs = []
    for far in (0.0, 0.005, 0.01, 0.02):
        moved = hand.pose.copy()
        moved[0] += far
        costs.append(cost(moved))
    assert costs[0] < 1.5  # mm; a finger before the palm has no edge in a plain image
    assert np.all(np.diff(costs) > 0.5)


def test_a_scene_out_of_sight_shows_nothing():
    hand = seen_hand()
    photograph = hand.photographs(hand.pose)[0]
    assert see_skin(photograph, hand.scene.pose_at(hand.pose).vertices + 5.0, 64) is None
