"""Where a hand's finger nails are: [T16] §3.3 looks for them in colour images."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.model.articulated import ArticulatedModel
from tracker.model.hand_axes import HandChains, find_bone_axes
from tracker.model.joints import FINGERS
from tracker.model.scene import Scene

Array = npt.NDArray[np.float64]

BEHIND_TIP, HALF_LENGTH, HALF_WIDTH = 0.50, 0.42, 0.36
"""Of the width of a finger's last segment: how far behind the tip a nail's middle lies, and half its sizes. They give
nails of 11 to 13 mm by 9 to 11 mm on the default hand's fingers; chosen by eye, for the hand models show no nails."""

REACH = 0.30
"""Of the same width; a surface point so much higher or lower than the nail's middle is not of the nail."""


@dataclass(frozen=True)
class Nail:
    """The nail of one finger, at rest, model frame, m.

    Attributes:
        finger: One of FINGERS.
        corners: (3,) vertices of the face with the nail's middle.
        shares: (3,) of these vertices in the middle.
        middle: (3,) on the surface.
        axes: (3, 3) rows: unit vectors towards the fingertip, across the nail, out of the back of the finger.
        half_length: Towards the fingertip.
        half_width: Across.
        reach: Out of the finger.
    """

    finger: str
    corners: npt.NDArray[np.int64]
    shares: Array
    middle: Array
    axes: Array
    half_length: float
    half_width: float
    reach: float

    def measure(self, points: Array) -> tuple[Array, Array]:
        """Of surface points (N, 3) at rest: (N,) distance from the middle, 1 at the nail's edge, infinite elsewhere on
        the hand; and (N,) how far towards the fingertip, 1 at the free edge."""
        along, across, out = self.axes @ (points - self.middle).T
        away = np.hypot(along / self.half_length, across / self.half_width)
        return np.where(np.abs(out) < self.reach, away, np.inf), along / self.half_length


def find_nails(model: ArticulatedModel) -> tuple[Nail, ...]:
    """The nails of a hand, thumb to little finger."""
    assert model.hand is not None, f"{model.name} is not a hand"
    scene = Scene((model,))
    joints = scene.pose_at(scene.rest_pose()).landmarks(0)
    chains = HandChains(
        model.hand.side, joints[0], {finger: joints[1 + 4 * n : 5 + 4 * n] for n, finger in enumerate(FINGERS)}
    )
    return tuple(_find_nail(model, chains, finger) for finger in FINGERS)


def _find_nail(model: ArticulatedModel, chains: HandChains, finger: str) -> Nail:
    assert model.hand is not None
    own = model.hand.finger_parts[f"{finger}_distal"]
    axes = find_bone_axes(chains, finger, 2)
    flexion = axes["flexion"]
    towards = axes["twist"] if chains.side == "right" else -axes["twist"]
    frame = np.stack([towards, flexion, np.cross(towards, flexion)])  # a positive turn about `flexion` bends inwards
    tip = chains.fingers[finger][-1]
    local = (model.vertices - tip) @ frame.T
    along = local[own, 0]
    width = float(np.ptp(local[own[along > np.median(along)], 1]))
    center = np.array([float(along.max()) - BEHIND_TIP * width, float(np.median(local[own, 1]))])
    faces = model.faces[np.isin(model.faces, own).all(axis=1)]
    shares = _find_shares(local[faces][:, :, :2], center)
    heights = np.einsum("fc,fc->f", shares, local[faces][:, :, 2])
    best = int(np.argmax(np.where((shares >= -1e-9).all(axis=1), heights, -np.inf)))
    corners = faces[best]
    middle = shares[best] @ model.vertices[corners]
    return Nail(finger, corners, shares[best], middle, frame, HALF_LENGTH * width, HALF_WIDTH * width, REACH * width)


def _find_shares(corners: Array, point: Array) -> Array:
    """(F, 3) shares of the corners (F, 3, 2) of triangles in a point (2,) of their plane."""
    (ax, ay), (bx, by), (cx, cy) = corners[:, 0].T, corners[:, 1].T, corners[:, 2].T
    area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
    area = np.where(np.abs(area) < 1e-18, np.inf, area)
    b = ((point[0] - ax) * (cy - ay) - (cx - ax) * (point[1] - ay)) / area
    c = ((bx - ax) * (point[1] - ay) - (point[0] - ax) * (by - ay)) / area
    return np.where(np.isinf(area)[:, None], -1.0, np.column_stack([1.0 - b - c, b, c]))
