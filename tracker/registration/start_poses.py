"""Poses that the search for a hand begins with: a straight hand, fists, and some between."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from tracker.model.blend_limits import CHAINS, BlendLimits

Array = npt.NDArray[np.float64]
Curl = tuple[float, float, float]

STRAIGHT: Curl = (5.0, 8.0, 5.0)
RELAXED: Curl = (25.0, 30.0, 15.0)
HALF: Curl = (45.0, 50.0, 28.0)
FOLDED: Curl = (80.0, 95.0, 55.0)
HOOK: Curl = (10.0, 90.0, 50.0)
TABLE: Curl = (75.0, 12.0, 6.0)
ROLLED: Curl = (70.0, 70.0, 35.0)

CURLS: tuple[Curl, ...] = (STRAIGHT, RELAXED, HALF, FOLDED, HOOK, TABLE, ROLLED)
"""Flexion of a finger's three joints, degrees."""

THUMBS: tuple[tuple[float, float, float, float], ...] = (
    (0.0, 0.0, 5.0, 5.0),
    (20.0, 0.0, 30.0, 30.0),
    (30.0, -15.0, 45.0, 55.0),
    (-15.0, 5.0, -5.0, -5.0),
    (0.0, -25.0, 15.0, 20.0),
)
"""Flexion and abduction of the thumb's first joint, flexion of the two others, degrees."""

START_POSES: tuple[tuple[Curl, Curl, Curl, Curl, int], ...] = (
    (STRAIGHT, STRAIGHT, STRAIGHT, STRAIGHT, 0),
    (RELAXED, RELAXED, RELAXED, RELAXED, 0),
    (HALF, HALF, HALF, HALF, 1),
    (FOLDED, FOLDED, FOLDED, FOLDED, 2),
    (FOLDED, FOLDED, FOLDED, FOLDED, 0),
    (HOOK, HOOK, HOOK, HOOK, 0),
    (TABLE, TABLE, TABLE, TABLE, 1),
    (STRAIGHT, FOLDED, FOLDED, FOLDED, 1),
    (STRAIGHT, STRAIGHT, FOLDED, FOLDED, 2),
    (HALF, HALF, FOLDED, FOLDED, 1),
    (HALF, STRAIGHT, STRAIGHT, STRAIGHT, 1),
)
"""Index, middle, ring, little finger, and which of THUMBS."""


def make_start_pose(limits: BlendLimits, number: int) -> Array:
    """(B, 3) one of START_POSES."""
    pose = limits.pose_at(np.zeros(limits.mean.shape))
    *curls, thumb = START_POSES[number]
    for finger, curl in zip(("index", "middle", "ring", "little"), curls, strict=True):
        pose = curl_finger(limits, pose, finger, curl)
    return turn_thumb(limits, pose, THUMBS[thumb])


def curl_finger(limits: BlendLimits, pose: Array, finger: str, curl: Curl) -> Array:
    """The pose with another curl of a finger; its abduction and twist become the prior's."""
    first, pose = CHAINS[finger], pose.copy()
    for number, degrees in enumerate(curl):
        angles = limits.mean[first - 1 + number].copy()
        angles[0] = np.radians(degrees)
        pose[first + number] = angles @ limits.axes[first - 1 + number]
    return pose


def turn_thumb(limits: BlendLimits, pose: Array, turn: tuple[float, float, float, float]) -> Array:
    """The pose with another turn of the thumb."""
    first, pose = CHAINS["thumb"], pose.copy()
    flexion, abduction, second, third = np.radians(turn)
    axes = limits.axes[first - 1 : first + 2]
    pose[first] = flexion * axes[0, 0] + abduction * axes[0, 1]
    pose[first + 1], pose[first + 2] = second * axes[1, 0], third * axes[2, 0]
    return pose
