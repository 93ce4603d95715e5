"""Compare a drawn hand with what was seen, pixel by pixel."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from numba import njit

from tracker.fitting.quality import Quality
from tracker.model.joints import HAND_JOINTS
from tracker.observation.observation import HAND, Observation
from tracker.rendering import View

ALIKE = 0.015
"""Drawn and seen depth within this agree, m."""

CUT = 0.020
"""Depth differences count no more than this in the score, m."""

REACH = 0.200
"""Hand pixels farther than this from the palm belong to something else, m."""

RIM = 0.0023
"""Misfit this near to the border of an area that does not agree is left out, m: noise and a model slightly too thin or
too thick make rims, a finger that is elsewhere makes an area."""

BROAD_RIM = 0.0045
"""The same for the verdict: real sensors make such fringes."""

ARM_LENGTH = 0.120
"""Fingers do not reach so far behind what is taken for the wrist, m."""

ARM_RADIUS = 0.045
"""Behind the wrist, pixels this near to the line through the middle of all that is there are the forearm, m."""


class HandPlace(NamedTuple):
    """Where a drawn hand is, for compiled code.

    Attributes:
        wrist: (3,) world, m.
        forward: (3,) unit, from the wrist to the middle finger's knuckle.
        palm: (3,) halfway between them.
    """

    wrist: npt.NDArray[np.float64]
    forward: npt.NDArray[np.float64]
    palm: npt.NDArray[np.float64]

    @classmethod
    def of(cls, joints: npt.NDArray[np.float64]) -> HandPlace:
        """Of joints (21, 3) world, m."""
        wrist, middle = joints[HAND_JOINTS.index("wrist")], joints[HAND_JOINTS.index("middle_mcp")]
        return cls(wrist, (middle - wrist) / max(float(np.linalg.norm(middle - wrist)), 1e-9), 0.5 * (wrist + middle))


def measure_quality(view: View, observation: Observation, model: int = 0) -> Quality:
    """Compare one hand of a drawn scene with the observation."""
    place = HandPlace.of(view.posed.landmarks(model))
    drawn_in = view.inverse_depth, view.face, view.posed.scene.face_models == model
    seen_in = observation.depth, observation.labels, observation.points
    camera = observation.K, observation.T_world_camera
    misfit, broad = _measure_misfit(*drawn_in, *seen_in, observation.nearest_pixel[0], *camera, place)
    counts, area, residuals = _compare(*drawn_in, *seen_in, place)
    drawn, drawn_alike, seen, seen_alike, both, reachable = (float(count) for count in counts)
    union = max(drawn + seen - both, 1.0)
    return Quality(
        depth_residual=float(np.median(residuals)) if len(residuals) else float("inf"),
        inside=drawn_alike / max(drawn, 1.0),
        explained=seen_alike / max(seen, 1.0),
        silhouette_iou=both / union,
        coverage=seen_alike / max(reachable, 1.0),
        misfit=misfit,
        broad_misfit=broad,
        area=float(area) / (observation.K[0, 0] * observation.K[1, 1]),
        score=1.0 - (float(np.minimum(residuals / CUT, 1.0).sum()) + union - both) / union,
    )


@njit(cache=True, nogil=True)
def _compare(inverse_depth, face, is_model, depth, labels, points, place):
    wrist, forward, palm = place
    height, width = labels.shape
    arm = _arm_direction(labels, points, wrist, forward)
    residuals = np.zeros(height * width)
    number = 0
    drawn = drawn_alike = seen = seen_alike = both = reachable = 0
    area = 0.0
    for row in range(height):
        for column in range(width):
            f = face[row, column]
            is_hand = labels[row, column] & HAND != 0
            is_drawn = f >= 0 and is_model[f]
            if f >= 0 and not is_drawn and abs(depth[row, column] - 1.0 / inverse_depth[row, column]) < ALIKE:
                continue  # another model explains this pixel
            z = 1.0 / inverse_depth[row, column] if is_drawn else 0.0
            hidden = labels[row, column] != 0 and depth[row, column] < (z - ALIKE if is_hand else z + ALIKE)
            difference = abs(depth[row, column] - z)
            counts_seen = is_hand and (is_drawn or _belongs(points[row, column], wrist, forward, palm, arm))
            if is_hand and _is_near(points[row, column], palm):
                reachable += 1
            if is_drawn and (is_hand or not hidden):
                drawn += 1
                if is_hand:
                    residuals[number] = difference
                    number += 1
                    if difference < ALIKE:
                        drawn_alike += 1
                        area += z * z
            if counts_seen:
                seen += 1
                if is_drawn:
                    both += 1
                    if difference < ALIKE:
                        seen_alike += 1
    return (drawn, drawn_alike, seen, seen_alike, both, reachable), area, residuals[:number]


@njit(cache=True, nogil=True)
def _measure_misfit(inverse_depth, face, is_model, depth, labels, points, nearest, K, T, place):
    """Area, m², of what is seen and not drawn and of what is drawn and not seen, each without its rim."""
    wrist, forward, palm = place
    height, width = labels.shape
    kind = np.zeros((height, width), dtype=np.uint8)
    f = 0.5 * (K[0, 0] + K[1, 1])
    palm_depth = 0.0
    for i in range(3):
        palm_depth += T[i, 2] * (palm[i] - T[i, 3])
    for row in range(height):
        for column in range(width):
            drawn = face[row, column]
            z = 1.0 / inverse_depth[row, column] if drawn >= 0 else 0.0
            seen = depth[row, column]
            is_own_nearest = nearest[row, column, 0] == row and nearest[row, column, 1] == column
            in_shadow = labels[row, column] == 0 and is_own_nearest
            if in_shadow and drawn < 0:
                kind[row, column] = 1
            if labels[row, column] & HAND and (drawn < 0 or abs(seen - z) >= ALIKE):
                point = points[row, column]
                if _is_near(point, palm) and not _is_behind(point, wrist, forward):
                    kind[row, column] = 1
            is_before_all = not in_shadow and (labels[row, column] == 0 or seen > z + ALIKE)
            if drawn >= 0 and is_model[drawn] and is_before_all:
                x, y = (column - K[0, 2]) / K[0, 0] * z, (row - K[1, 2]) / K[1, 1] * z
                before = 0.0
                for i in range(3):
                    before += forward[i] * (T[i, 0] * x + T[i, 1] * y + T[i, 2] * z + T[i, 3] - wrist[i])
                if before > 0.0:
                    kind[row, column] |= 2
    area, broad = 0.0, 0.0
    for row in range(height):
        for column in range(width):
            if kind[row, column] == 0:
                continue
            z = palm_depth
            if labels[row, column] != 0:
                z = depth[row, column]
            elif face[row, column] >= 0:
                z = 1.0 / inverse_depth[row, column]
            if _is_inner(kind, row, column, max(1, round(RIM * f / z))):
                area += z * z / (K[0, 0] * K[1, 1])
                if _is_inner(kind, row, column, max(1, round(BROAD_RIM * f / z))):
                    broad += z * z / (K[0, 0] * K[1, 1])
    return area, broad


@njit(cache=True, nogil=True)
def _is_inner(kind, row, column, rim):
    """Whether all pixels around share a kind of misfit with this one; the border of the image is a rim."""
    height, width = kind.shape
    if row < rim or column < rim or row >= height - rim or column >= width - rim:
        return False
    shared = kind[row, column]
    for r in range(row - rim, row + rim + 1):
        for c in range(column - rim, column + rim + 1):
            shared &= kind[r, c]
            if shared == 0:
                return False
    return True


@njit(cache=True, nogil=True)
def _arm_direction(labels, points, wrist, forward):
    """(3,) mean direction from the wrist to hand pixels behind it; zeros where they are too short to be a forearm.

    Fingers end within ARM_LENGTH of their knuckles; what a border of the region cuts off may go on.
    """
    height, width = labels.shape
    direction = np.zeros(3)
    for row in range(height):
        for column in range(width):
            if labels[row, column] & HAND and _is_behind(points[row, column], wrist, forward):
                for i in range(3):
                    direction[i] += points[row, column, i] - wrist[i]
    length = np.sqrt(direction[0] ** 2 + direction[1] ** 2 + direction[2] ** 2)
    if length == 0.0:
        return direction
    direction /= length
    for row in range(height):
        for column in range(width):
            if labels[row, column] & HAND and _is_behind(points[row, column], wrist, forward):
                is_cut = row == 0 or column == 0 or row == height - 1 or column == width - 1
                along, across = 0.0, 0.0
                for i in range(3):
                    step = points[row, column, i] - wrist[i]
                    along += step * direction[i]
                    across += step * step
                if across - along * along < ARM_RADIUS * ARM_RADIUS and (is_cut or along > ARM_LENGTH):
                    return direction
    direction[:] = 0.0
    return direction


@njit(cache=True, nogil=True)
def _is_behind(point, wrist, forward):
    x, y, z = point[0] - wrist[0], point[1] - wrist[1], point[2] - wrist[2]
    return x * forward[0] + y * forward[1] + z * forward[2] < -0.01 and x * x + y * y + z * z < REACH * REACH


@njit(cache=True, nogil=True)
def _is_near(point, palm):
    x, y, z = point[0] - palm[0], point[1] - palm[1], point[2] - palm[2]
    return x * x + y * y + z * z < REACH * REACH


@njit(cache=True, nogil=True)
def _belongs(point, wrist, forward, palm, arm):
    """Whether a hand pixel should have been explained by this hand: near its palm and not on its forearm."""
    if not _is_near(point, palm):
        return False
    wx, wy, wz = point[0] - wrist[0], point[1] - wrist[1], point[2] - wrist[2]
    if wx * forward[0] + wy * forward[1] + wz * forward[2] > 0.0:
        return True
    if arm[0] == 0.0 and arm[1] == 0.0 and arm[2] == 0.0:
        return True
    along = wx * arm[0] + wy * arm[1] + wz * arm[2]
    return wx * wx + wy * wy + wz * wz - along * along > ARM_RADIUS * ARM_RADIUS
