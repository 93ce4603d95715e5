"""What makes a T16 model a hand: its bones by name, its tips, its chains of joints."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.model.articulated import HandParts
from tracker.model.hand_axes import HandChains
from tracker.model.hand_parts import find_hand_parts, finger_segments
from tracker.model.joints import FINGERS
from tracker.model.skeleton import Array

FINGER_NUMBERS: tuple[str, ...] = ("little", "ring", "middle", "index", "thumb")
"""Finger number in T16's bone names, and the order of a .VOI row."""


@dataclass(frozen=True)
class T16Hand:
    """A hand's bones.

    Attributes:
        side: "right" or "left".
        wrist: Bone of the wrist.
        fingers: For each of FINGERS its bones, palm first.
    """

    side: str
    wrist: int
    fingers: dict[str, tuple[int, ...]]

    def find_tips(
        self, vertices: Array, weights: Array, joints: Array, voi: npt.NDArray[np.int64] | None
    ) -> npt.NDArray[np.int64]:
        """(5,) vertex at the tip of each of FINGERS: from the .VOI file, else the farthest along the last bone."""
        if voi is not None:
            return np.array([voi[0, FINGER_NUMBERS.index(finger)] for finger in FINGERS])
        dominant = np.argmax(weights, axis=1)
        tips = []
        for finger in FINGERS:
            last, before = self.fingers[finger][-1], self.fingers[finger][-2]
            reach = vertices @ (joints[last] - joints[before])
            tips.append(int(np.argmax(np.where(dominant == last, reach, -np.inf))))
        return np.array(tips)

    def chains(self, joints: Array, tip_points: Array) -> HandChains:
        """The joints (B, 3) and tips (5, 3) as chains from palm to tip."""
        fingers = {
            finger: np.concatenate([joints[list(self.fingers[finger])], tip_points[number][None]])
            for number, finger in enumerate(FINGERS)
        }
        return HandChains(self.side, joints[self.wrist], fingers)

    def parts(self, vertices: Array, weights: Array, joints: Array, tips: npt.NDArray[np.int64]) -> HandParts:
        return find_hand_parts(self.side, vertices, weights, joints, self.wrist, self.fingers, tips)


def find_hand(names: tuple[str, ...]) -> T16Hand | None:
    """The hand that these bones are, or None for an object."""
    bones: dict[str, list[int]] = {finger: [] for finger in FINGERS}
    sides = set()
    for bone, name in enumerate(names):
        match = re.fullmatch(r"([RL])Fing\.([0-4])_(Hand|[0-2])", name)
        if match:
            sides.add("right" if match[1] == "R" else "left")
            bones[FINGER_NUMBERS[int(match[2])]].append(bone)
    if len(sides) != 1 or any(len(bones[finger]) != len(finger_segments(finger)) for finger in FINGERS):
        return None
    wrist = next((bone for bone, name in enumerate(names) if name.startswith("Lower Arm")), 0)
    return T16Hand(sides.pop(), wrist, {finger: tuple(ids) for finger, ids in bones.items()})
