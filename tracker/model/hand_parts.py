"""The landmarks of a hand, found from its bones, its skinning weights and its five tips."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from tracker.model.articulated import HandParts
from tracker.model.joints import FINGERS, HAND_JOINTS
from tracker.model.skeleton import Array

FINGER_SEGMENTS: tuple[str, ...] = ("metacarpal", "proximal", "middle", "distal")
THUMB_SEGMENTS: tuple[str, ...] = ("metacarpal", "proximal", "distal")

FINGERTIP_SHARE = 0.55
"""A fingertip begins at this share of the way from the last joint of the finger to its tip."""


def finger_segments(finger: str) -> tuple[str, ...]:
    """Names of the bones of a finger, palm first."""
    return THUMB_SEGMENTS if finger == "thumb" else FINGER_SEGMENTS


def find_hand_parts(
    side: str,
    vertices: Array,
    skinning_weights: Array,
    joints: Array,
    wrist: int,
    finger_bones: dict[str, tuple[int, ...]],
    tips: npt.NDArray[np.int64],
) -> HandParts:
    """Joints, fingertips and finger parts of a hand.

    Args:
        side: "right" or "left".
        vertices: (V, 3) rest pose, model frame, m.
        skinning_weights: (V, B).
        joints: (B, 3) joints at rest, model frame, m.
        wrist: Bone of the wrist.
        finger_bones: For each of FINGERS its bones, palm first: metacarpal (may be missing), proximal, middle, distal.
        tips: (5,) vertex at the tip of each of FINGERS.
    """
    assert side in ("right", "left") and set(finger_bones) == set(FINGERS) and tips.shape == (len(FINGERS),)
    joint_bones = np.full(len(HAND_JOINTS), -1, dtype=np.int64)
    joint_vertices = np.full(len(HAND_JOINTS), -1, dtype=np.int64)
    joint_bones[0] = wrist
    dominant = np.argmax(skinning_weights, axis=1)
    fingertips = []
    parts = {"wrist": np.flatnonzero(dominant == wrist)}
    for number, finger in enumerate(FINGERS):
        bones = finger_bones[finger]
        assert bones and len(bones) >= 3
        first = 1 + 4 * number
        joint_bones[first : first + 3] = bones[-3:]
        joint_vertices[first + 3] = tips[number]
        fingertips.append(_find_fingertip(vertices, dominant == bones[-1], joints[bones[-1]], int(tips[number])))
        for segment, bone in zip(finger_segments(finger)[-len(bones) :], bones, strict=True):
            parts[f"{finger}_{segment}"] = np.flatnonzero(dominant == bone)
    return HandParts(side, joint_bones, joint_vertices, tuple(fingertips), parts)


def find_tip(vertices: Array, weights: Array, chain: Array) -> int:
    """The vertex at the tip of a finger: far along its last bone and near its line.

    Args:
        vertices: (V, 3).
        weights: (V,) how much each vertex follows the last bone.
        chain: (n, 3) joints of the finger and the end of its last bone.
    """
    along = (chain[-1] - chain[-2]) / np.linalg.norm(chain[-1] - chain[-2])
    offset = vertices - chain[-2]
    reach = offset @ along
    aside = np.linalg.norm(offset - reach[:, None] * along, axis=1)
    return int(np.argmax(np.where(weights > 0.5 * weights.max(), reach - 0.8 * aside, -np.inf)))


def _find_fingertip(vertices: Array, is_distal: npt.NDArray[np.bool_], joint: Array, tip: int) -> npt.NDArray[np.int64]:
    along = vertices[tip] - joint
    share = (vertices - joint) @ along / max(float(along @ along), 1e-12)
    is_tip = is_distal & (share >= FINGERTIP_SHARE)
    is_tip[tip] = True
    return np.flatnonzero(is_tip)
