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

COVERAGE_GAIN = 0.25
"""Merit of covering all hand pixels within reach."""

RIM = 0.0023
"""Misfit this near to the border of an area that does not agree is left out, m: noise and a model slightly too thin or
too thick make rims, a finger that is elsewhere makes an area."""

BROAD_RIM = 0.0045
"""The same for the verdict: real sensors make such fringes."""

ELSEWHERE = 0.7
"""A finger whose joints are this far from where the hand detector saw them, `Sighting.measure`, is elsewhere. Measured
with onnxruntime and before second tries waited (today's counts: docs/studies/real_marks.md): with 0.6, 59 of 126 frames
of an infrared recording are called lost, 2 of 8 marked ones wrongly; with 0.8, 48, and 3 of the 8 are called `ok` with
a fingertip in a wrong place. `uvr_cube_white` had 3 to 5 lost of 200 with any."""

HAND_ELSEWHERE = 0.75
"""A hand all of whose joints are that far from where it was seen is elsewhere where some misfit is left: a box passes
for a palm, a mirrored hand for the hand. Where the depth image settles it the detector is wrong: 3 of 12 frames of
`uvr_cube_white` that were called lost before look right in what shows of the hand; they are not marked."""

MISFIT, BROAD_MISFIT = 1.1e-4, 6e-5
"""More than this area, m², where drawn and seen disagree means that some finger is elsewhere: by the depth image alone,
and where the hand detector says so too."""

SHOWN = 1.2e-3
"""Of a hand that is followed this much shows, m²; one that is not there hides within, or behind, the other."""

ARM_LENGTH = 0.120
"""Fingers do not reach so far behind what is taken for the wrist, m."""

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
        coverage: Share of all hand pixels within reach, forearm and all, whose depth agrees with a drawn pixel.
        misfit: Area, m², without its rim, of hand pixels before the wrist that no model explains, of skin in a depth
            shadow that none covers, and of drawn pixels before the wrist where something farther away, or free space,
            is seen.
        broad_misfit: The same without a wider rim: half of a finger's width is left of a finger that is elsewhere, and
            nothing of the fringe around a hand that is thinner, or is seen fatter, than its model.
        area: Of the drawn pixels whose depth agrees with a hand pixel, m², across the viewing rays.
        apart: Mean distance of the joints from where the hand detector saw them, 0 to 1 (`Sighting.measure`); None
            where it did not see the hand.
        worst_finger: The same of the finger that is farthest off.
    """

    depth_residual: float
    inside: float
    explained: float
    silhouette_iou: float
    score: float
    coverage: float
    misfit: float
    broad_misfit: float
    area: float
    apart: float | None = None
    worst_finger: float | None = None

    @property
    def merit(self) -> float:
        """To compare different places of a hand by: one that leaves fingers to pass for a forearm covers less."""
        return self.score + COVERAGE_GAIN * self.coverage

    @property
    def agrees(self) -> bool:
        """Whether the hand is in its place; some fingers may not be."""
        return self.score >= 0.45 and self.inside >= 0.6 and self.explained >= 0.65 and self.depth_residual <= 0.010

    @property
    def is_gone(self) -> bool:
        """Whether the hand is not in its place, or nothing shows of it; pixels of another hand do not tell."""
        return not self.agrees or self.area < SHOWN

    @property
    def is_lost(self) -> bool:
        """Whether no one should believe this pose.

        A real hand of another shape leaves some misfit with every finger in its place; where the detector saw the hand,
        it says whether one is not.
        """
        if self.worst_finger is None:
            return self.is_gone or self.misfit > MISFIT
        is_finger_elsewhere = self.broad_misfit > BROAD_MISFIT and self.worst_finger > ELSEWHERE
        is_hand_elsewhere = self.misfit > BROAD_MISFIT and (self.apart or 0.0) > HAND_ELSEWHERE
        return self.is_gone or is_finger_elsewhere or is_hand_elsewhere


def measure_quality(view: View, observation: Observation, model: int = 0) -> Quality:
    """Compare one hand of a drawn scene with the observation."""
    joints = view.posed.landmarks(model)
    wrist = joints[HAND_JOINTS.index("wrist")]
    middle = joints[HAND_JOINTS.index("middle_mcp")]
    forward = (middle - wrist) / max(float(np.linalg.norm(middle - wrist)), 1e-9)
    misfit, broad = _measure_misfit(
        view.inverse_depth,
        view.face,
        view.posed.scene.face_models == model,
        observation.depth,
        observation.labels,
        observation.nearest_pixel[0],
        observation.points,
        observation.K,
        observation.T_world_camera,
        wrist,
        forward,
        0.5 * (wrist + middle),
    )
    counts, area, residuals = _compare(
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
def _compare(inverse_depth, face, is_model, depth, labels, points, wrist, forward, palm):
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
def _measure_misfit(inverse_depth, face, is_model, depth, labels, nearest, points, K, T, wrist, forward, palm):
    """Area, m², of what is seen and not drawn and of what is drawn and not seen, each without its rim."""
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
