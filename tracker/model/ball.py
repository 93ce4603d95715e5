"""A sphere as a rigid model."""

from __future__ import annotations

import numpy as np
import trimesh

from tracker.model.articulated import ArticulatedModel
from tracker.model.skeleton import Skeleton


def make_ball(radius: float = 0.032) -> ArticulatedModel:
    """A rigid sphere about its centre, radius in m; a tennis ball's unless told otherwise."""
    mesh = trimesh.creation.icosphere(subdivisions=3, radius=radius)
    nothing = np.zeros(0)
    skeleton = Skeleton(
        bone_names=("ball",),
        parents=np.array([-1]),
        Ts_model_bone=np.eye(4)[None],
        dof_bones=np.zeros(0, dtype=np.int64),
        dof_axes=np.zeros((0, 3)),
        lower=nothing,
        upper=nothing,
    )
    vertices = np.asarray(mesh.vertices, dtype=np.float64)
    return ArticulatedModel(
        "ball", vertices, np.asarray(mesh.faces, dtype=np.int64), np.ones((len(vertices), 1)), skeleton
    )
