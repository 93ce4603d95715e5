"""A ball in the palm of a performing hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import trimesh

from tracker.model.articulated import ArticulatedModel
from tracker.model.joints import HAND_JOINTS
from tracker.model.skeleton import Skeleton
from tracker.synthesis.actor import Actor
from tracker.synthesis.performance import Performance
from tracker.synthesis.shading import OBJECT_COLORS

RADIUS = 0.032
"""m, about a tennis ball's."""

ABOVE_PALM = 0.016
"""Between the bones of the palm and the ball's surface, m: about the flesh there."""


def make_ball(radius: float = RADIUS) -> ArticulatedModel:
    """A rigid sphere about its centre, radius in m."""
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
        "ball", vertices, np.asarray(mesh.faces, dtype=np.int32), np.ones((len(vertices), 1)), skeleton
    )


def with_ball(performance: Performance, radius: float = RADIUS) -> Performance:
    """The same hands, and a ball that lies in the first one's palm, on the camera's side, and moves with it."""
    hand, camera = performance.hands[0], performance.camera
    joints = hand.joints(0, hand.vertices(0))
    palm = 0.5 * (joints[HAND_JOINTS.index("wrist")] + joints[HAND_JOINTS.index("middle_mcp")])
    towards = camera.T_world_camera[:3, 3] - palm
    center = palm + (radius + ABOVE_PALM) * towards / np.linalg.norm(towards)
    roots = np.array([hand.T_world_model(moment) for moment in range(hand.num_moments)])
    first = np.eye(4)
    first[:3, 3] = center
    motion = (roots @ np.linalg.inv(roots[0]) @ first)[:, None, :3]
    ball = Actor("ball", make_ball(radius), motion, OBJECT_COLORS[0])
    return replace(performance, actors=(*performance.actors, ball))
