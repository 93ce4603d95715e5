"""How deep the true motions of a twin are in themselves: what penetration must be judged by."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.studies.twin_runs import FACES
from tracker.geometry.vertex_normals import normals_into
from tracker.model.scene import Scene
from tracker.synthesis.performance import Performance
from tracker.synthesis.twin import load_twin
from tracker.terms.penetration import measure_penetration


@dataclass(frozen=True)
class TruePenetration:
    """The deepest of every frame, of a sequence's true surfaces."""

    sequence: str
    step: int
    frames: int | None = None

    def __call__(self, data: Path, twins: Path) -> dict[str, Any]:
        """Pose and measure; nothing is rendered."""
        performance = load_twin(data, self.sequence, FACES)
        last = performance.num_moments if self.frames is None else min(self.frames, performance.num_moments)
        depths = [1e3 * depth for depth in measure_true_penetrations(performance, range(0, last, self.step))]
        return {"deepest_mm": max(depths), "mean_deepest_mm": float(np.mean(depths))}


def measure_true_penetrations(performance: Performance, moments: range) -> list[float]:
    """m, at each moment."""
    scene = Scene(tuple(actor.model for actor in performance.actors))
    posed, depths = scene.pose_at(scene.rest_pose()), []
    for moment in moments:
        true = [actor.vertices(moment) for actor in performance.actors]
        vertices = posed.vertices.copy()
        for where, own in zip(scene.vertex_slices, true, strict=True):
            vertices[where] = own
        normals = np.zeros_like(vertices)
        normals_into(normals, vertices, scene.arrays.faces)
        depths.append(measure_penetration(replace(posed, vertices=vertices, normals=normals)))
    return depths
