"""How far and how likely each ball joint of a blend model turns about its anatomical axes.

MANO's joints are balls, though most of a hand's are hinges ([R17] 3.3): fitted to a scan with no more than a neutral
prior they twist fingers about themselves. Here each has three axes that follow from the joints at rest, the same signs
for both hands (`hand_axes`), and for each axis a prior and limits. Angles are the rotation vector's components along
the axes, which for hinges, and near the rest pose, are the angles of anatomy.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tracker.model.blend_model import BlendModel
from tracker.model.hand_axes import HandChains, derive_hand_joints, find_bone_axes
from tracker.model.joints import FINGERS
from tracker.model.skeleton import Array

MOTIONS: tuple[str, ...] = ("flexion", "abduction", "twist")
CHAINS = {"index": 1, "middle": 4, "little": 7, "ring": 10, "thumb": 13}
"""First bone of each finger in MANO's order."""

STIFF_DEG = 8.0
"""Limit of a motion that anatomy hardly allows."""
ARCH_DEG = 12.0
"""So much further do the first joints of ring and little finger bend: MANO has no metacarpals to arch the palm with."""

FLEXION_MEAN_DEG = 15.0
"""Of the prior of every joint of a finger, from the rest pose; the thumb's mean is the rest pose."""
FINGER_SD_DEG = {1: (28.0, 8.0, 4.0), 2: (28.0, 3.0, 3.0), 3: (28.0, 3.0, 3.0)}
THUMB_SD_DEG = {1: (15.0, 12.0, 10.0), 2: (15.0, 6.0, 5.0), 3: (22.0, 3.0, 3.0)}
"""Standard deviations of that prior by motion, of the first, second and third joint."""


@dataclass(frozen=True, eq=False)
class BlendLimits:
    """Axes, prior and limits of the K joints behind the root; the last axis of each array goes over MOTIONS.

    Attributes:
        axes: (K, 3, 3) rows are the unit axes of flexion, abduction and twist, model frame at rest.
        mean: (K, 3) of the prior, rad from the rest pose.
        deviation: (K, 3) of the prior, rad.
        lower: (K, 3) rad.
        upper: (K, 3) rad.
    """

    axes: Array
    mean: Array
    deviation: Array
    lower: Array
    upper: Array

    def angles(self, pose: Array) -> Array:
        """(K, 3) angles of a pose (K + 1, 3), rad."""
        return np.einsum("kax,kx->ka", self.axes, pose[1:])

    def clamped(self, pose: Array) -> Array:
        """The pose with every angle within its limits; the root stays."""
        angles = np.clip(self.angles(pose), self.lower, self.upper)
        return np.concatenate([pose[:1], np.einsum("kax,ka->kx", self.axes, angles)])

    def pose_at(self, angles: Array) -> Array:
        """(K + 1, 3) the pose with these angles (K, 3), its root not turned."""
        return np.concatenate([np.zeros((1, 3)), np.einsum("kax,ka->kx", self.axes, angles)])


def blend_limits(model: BlendModel) -> BlendLimits:
    """Worked out from where the joints and tips of a model with MANO's joints are at rest, of its mean shape.

    Args:
        model: A hand of 16 joints in MANO's order, near the flat pose at rest.
    """
    chains = blend_chains(model, np.zeros(model.num_shape))
    count = model.num_bones - 1
    axes = np.zeros((count, 3, 3))
    mean, deviation = np.zeros((count, 3)), np.zeros((count, 3))
    lower, upper = np.full((count, 3), -np.radians(STIFF_DEG)), np.full((count, 3), np.radians(STIFF_DEG))
    for finger, first in CHAINS.items():
        for number in range(3):
            row = first - 1 + number
            own = find_bone_axes(chains, finger, number)
            axes[row] = [own[motion] for motion in MOTIONS]
            if finger == "thumb":
                deviation[row] = np.radians(THUMB_SD_DEG[number + 1])
            else:
                deviation[row] = np.radians(FINGER_SD_DEG[number + 1])
                mean[row, 0] = np.radians(FLEXION_MEAN_DEG)
    for joint in derive_hand_joints(chains):
        row = CHAINS[joint.finger] - 1 + chains.segments(joint.finger).index(joint.segment)
        motion = MOTIONS.index(joint.motion)
        lower[row, motion], upper[row, motion] = joint.lower, joint.upper
    for finger in ("ring", "little"):
        upper[CHAINS[finger] - 1, 0] += np.radians(ARCH_DEG)
    return BlendLimits(axes, mean, deviation, lower, upper)


def blend_chains(model: BlendModel, shape: Array) -> HandChains:
    """Wrist and fingers at rest."""
    shaped = model.shaped(shape)
    joints = model.joints_of(shaped)
    fingers = {
        finger: np.concatenate([joints[CHAINS[finger] : CHAINS[finger] + 3], shaped[model.tips[number]][None]])
        for number, finger in enumerate(FINGERS)
    }
    return HandChains(model.side, joints[0], fingers)


def turn_jacobian(rotation_vectors: Array) -> Array:
    """(N, 3, 3) derivative of log(exp(δ) exp(θ)) by δ at 0: the inverse of the left Jacobian of SO(3) at θ (N, 3)."""
    angle = np.linalg.norm(rotation_vectors, axis=1)
    half = 0.5 * np.maximum(angle, 1e-4)
    share = np.where(angle < 1e-4, 1.0 / 12.0, (1.0 - half / np.tan(half)) / np.maximum(angle, 1e-4) ** 2)
    x, y, z = rotation_vectors.T
    zero = np.zeros_like(x)
    hat = np.stack([zero, -z, y, z, zero, -x, -y, x, zero], axis=1).reshape(-1, 3, 3)
    return np.eye(3) - 0.5 * hat + share[:, None, None] * (hat @ hat)
