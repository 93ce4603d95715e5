"""The search for a pose, on a drawn tube."""

from __future__ import annotations

import numpy as np

from benchmarks.baselines.discrepancy import Discrepancy
from benchmarks.baselines.pose_search import search_pose
from benchmarks.baselines.swarm_options import SwarmOptions
from benchmarks.baselines.swarm_tracker import thin_to
from tests.tracker.scenes import drawn_tube


def test_a_displaced_tube_is_found_within_its_limits(rng):
    drawn = drawn_tube()
    start = drawn.disturbed(rng, angle=0.15, shift=0.01)
    pose, _ = search_pose(
        drawn.scene, Discrepancy(drawn.scene, thin_to(drawn.observation, 64)), start, SwarmOptions(), rng
    )
    truth = drawn.scene.pose_at(drawn.pose).vertices

    def error(at: np.ndarray) -> float:
        return float(np.linalg.norm(drawn.scene.pose_at(at).vertices - truth, axis=1).mean())

    assert error(pose) < 0.4 * error(start)
    assert np.all(pose >= drawn.scene.lower) and np.all(pose <= drawn.scene.upper)
