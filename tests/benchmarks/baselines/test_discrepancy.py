"""The cost that the swarm minimises, on a drawn tube."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from benchmarks.baselines.discrepancy import ALIKE, CUT, SILHOUETTE_WEIGHT, Discrepancy
from tests.tracker.scenes import drawn_tube
from tracker.fitting.frame_fit import draw, label_scene
from tracker.observation import HAND


def test_the_true_pose_costs_next_to_nothing_and_an_empty_view_most():
    drawn = drawn_tube()
    cost = Discrepancy(drawn.scene, drawn.observation)
    assert cost(drawn.pose) < 0.2  # mm
    away = drawn.pose.copy()
    away[0] += 1.0
    assert cost(away) == CUT + SILHOUETTE_WEIGHT


def test_the_fast_drawing_gives_what_the_plain_formula_gives(rng):
    drawn = drawn_tube()
    seen = drawn.observation.thin(2)
    pose = drawn.disturbed(rng)
    view = draw(drawn.scene.pose_at(pose), seen)
    bits = label_scene(drawn.scene)[1]
    is_drawn, is_seen = view.face >= 0, seen.labels & bits[0] != 0
    difference = np.where(is_drawn & is_seen, np.abs(1e3 * (seen.depth - view.depth)), CUT)
    match = is_drawn & is_seen & (difference < ALIKE)
    either = is_drawn | is_seen
    overlap = 2 * match.sum() / (match.sum() + either.sum())
    expected = np.minimum(difference, CUT)[either].mean() + SILHOUETTE_WEIGHT * (1 - overlap)
    cost = Discrepancy(drawn.scene, seen)
    cost(drawn.pose)
    assert np.isclose(cost(pose), expected, rtol=1e-9)


def test_what_is_nearer_and_nobodys_hides_without_cost_but_what_is_behind_does_not():
    drawn = drawn_tube()
    seen = drawn.observation
    cost = Discrepancy(drawn.scene, seen)(drawn.pose)
    half = np.zeros_like(seen.labels, dtype=bool)
    half[:, : half.shape[1] // 2] = True
    half &= seen.labels != 0
    labels = np.where(half, np.uint8(HAND), seen.labels)  # a tube is no hand
    nearer = replace(seen, labels=labels, depth=np.where(half, np.float32(0.1), seen.depth))
    behind = replace(seen, labels=labels, depth=np.where(half, np.float32(0.6), seen.depth))
    assert Discrepancy(drawn.scene, nearer)(drawn.pose) < cost + 0.2
    assert Discrepancy(drawn.scene, behind)(drawn.pose) > cost + 10.0
