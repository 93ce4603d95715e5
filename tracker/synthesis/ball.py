"""A ball in the palm of a performing hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tracker.model.ball import make_ball
from tracker.model.joints import HAND_JOINTS
from tracker.synthesis.actor import Actor
from tracker.synthesis.performance import Performance
from tracker.synthesis.shading import OBJECT_COLORS

RADIUS = 0.032
"""m, about a tennis ball's."""

ABOVE_PALM = 0.016
"""Between the bones of the palm and the ball's surface, m: about the flesh there."""


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
