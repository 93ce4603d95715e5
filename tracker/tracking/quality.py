"""How well a fitted pose explains what was seen: what tells a followed hand from a lost one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from tracker.model.joints import HAND_JOINTS
from tracker.observation import HAND, Observation
from tracker.rendering import View

ALIKE = 0.015
"""Drawn and seen depth within this agree, m."""

CUT = 0.020
"""Depth differences count no more than this in the score, m."""

REACH = 0.200
"""Hand pixels farther than this from the palm belong to something else, m."""

ARM_RADIUS = 0.045
"""Behind the wrist, pixels this near to the line through the middle of all that is there are the forearm, m."""


@dataclass(frozen=True)
class Quality:
    """Agreement of a drawn hand with the hand pixels.

    Attributes:
        depth_residual: Median |drawn − seen| where both are, m; infinite where they never meet.
        inside: Share of drawn pixels, hidden ones apart, whose depth agrees with a hand pixel.
        explained: Share of hand pixels, forearm apart, whose depth agrees with a drawn pixel.
        silhouette_iou: Drawn and seen pixels (forearm and hidden apart): intersection over union.
        score: 0 to 1, to compare poses by: one minus the mean over that union of |drawn − seen| cut off at 20 mm, in
            units of the cut; a pixel that is only drawn or only seen counts as cut off.
    """

    depth_residual: float
    inside: float
    explained: float
    silhouette_iou: float
    score: float

    @property
    def is_lost(self) -> bool:
        """Whether no one should believe this pose."""
        return self.score < 0.4 or self.inside < 0.6 or self.explained < 0.5 or self.depth_residual > 0.010


def measure_quality(view: View, observation: Observation, model: int = 0) -> Quality:
    """Compare one hand of a drawn scene with the observation."""
    joints = view.posed.landmarks(model)
    wrist = joints[HAND_JOINTS.index("wrist")]
    middle = joints[HAND_JOINTS.index("middle_mcp")]
    forward = (middle - wrist) / max(float(np.linalg.norm(middle - wrist)), 1e-9)
    counts, residuals = _compare(
        view.inverse_depth,
        view.face,
        view.posed.scene.face_models == model,
        observation.depth,
        observation.labels,
        observation.points,
        wrist,
        forward,
        0.5 * (wrist + middle),
    )
    drawn, drawn_alike, seen, seen_alike, both = (float(count) for count in counts)
    union = max(drawn + seen - both, 1.0)
    return Quality(
        depth_residual=float(np.median(residuals)) if len(residuals) else float("inf"),
        inside=drawn_alike / max(drawn, 1.0),
        explained=seen_alike / max(seen, 1.0),
        silhouette_iou=both / union,
        score=1.0 - (float(np.minimum(residuals / CUT, 1.0).sum()) + union - both) / union,
    )


@njit(cache=True, nogil=True)
def _compare(inverse_depth, face, is_model, depth, labels, points, wrist, forward, palm):
    height, width = labels.shape
    arm = _arm_direction(labels, points, wrist, forward)
    residuals = np.zeros(height * width)
    number = 0
    drawn = drawn_alike = seen = seen_alike = both = 0
    for row in range(height):
        for column in range(width):
            f = face[row, column]
            is_hand = labels[row, column] & HAND != 0
            is_drawn = f >= 0 and is_model[f]
            z = 1.0 / inverse_depth[row, column] if is_drawn else 0.0
            hidden = labels[row, column] != 0 and depth[row, column] < z - ALIKE
            difference = abs(depth[row, column] - z)
            counts_seen = is_hand and (is_drawn or _belongs(points[row, column], wrist, forward, palm, arm))
            if is_drawn and (is_hand or not hidden):
                drawn += 1
                if is_hand:
                    residuals[number] = difference
                    number += 1
                    if difference < ALIKE:
                        drawn_alike += 1
            if counts_seen:
                seen += 1
                if is_drawn:
                    both += 1
                    if difference < ALIKE:
                        seen_alike += 1
    return (drawn, drawn_alike, seen, seen_alike, both), residuals[:number]


@njit(cache=True, nogil=True)
def _arm_direction(labels, points, wrist, forward):
    """(3,) mean direction from the wrist to hand pixels behind it; against the fingers where there are none."""
    sx = sy = sz = 0.0
    for row in range(labels.shape[0]):
        for column in range(labels.shape[1]):
            if labels[row, column] & HAND == 0:
                continue
            x, y, z = (
                points[row, column, 0] - wrist[0],
                points[row, column, 1] - wrist[1],
                points[row, column, 2] - wrist[2],
            )
            if x * forward[0] + y * forward[1] + z * forward[2] < -0.01 and x * x + y * y + z * z < REACH * REACH:
                sx, sy, sz = sx + x, sy + y, sz + z
    length = np.sqrt(sx * sx + sy * sy + sz * sz)
    direction = np.empty(3)
    if length > 0.0:
        direction[0], direction[1], direction[2] = sx / length, sy / length, sz / length
    else:
        direction[0], direction[1], direction[2] = -forward[0], -forward[1], -forward[2]
    return direction


@njit(cache=True, nogil=True)
def _belongs(point, wrist, forward, palm, arm):
    """Whether a hand pixel should have been explained by this hand: near its palm and not on its forearm."""
    px, py, pz = point[0] - palm[0], point[1] - palm[1], point[2] - palm[2]
    if px * px + py * py + pz * pz > REACH * REACH:
        return False
    wx, wy, wz = point[0] - wrist[0], point[1] - wrist[1], point[2] - wrist[2]
    if wx * forward[0] + wy * forward[1] + wz * forward[2] > 0.0:
        return True
    along = wx * arm[0] + wy * arm[1] + wz * arm[2]
    return wx * wx + wy * wy + wz * wz - along * along > ARM_RADIUS * ARM_RADIUS
