"""A sphere as a rigid model."""

from __future__ import annotations

import numpy as np
import trimesh

from tracker.model.articulated import ArticulatedModel
from tracker.model.skeleton import Skeleton


def make_ball(radius: float = 0.032) -> ArticulatedModel:
    """A rigid sphere about its centre, radius in m; a tennis ball's unless told otherwise."""
    mesh = trimesh.creation.icosphere(subdivisions=3, radius=radius)
    vertices = np.asarray(mesh.vertices, dtype=np.float64)
    faces, skeleton = np.asarray(mesh.faces, dtype=np.int64), Skeleton.of_one_bone("ball", np.zeros(3))
    return ArticulatedModel("ball", vertices, faces, np.ones((len(vertices), 1)), skeleton)
