"""Anatomical axes and limits of a hand's joints, worked out from where the joints are at rest.

Signs are the same for both hands: positive flexion bends towards the palm; positive abduction turns a finger towards
the thumb's side of the hand and the thumb away from the index finger; positive twist follows the right-hand rule about
the bone on a right hand and the left-hand rule on a left one. Mirrored hands thus share their angles.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tracker.model.hand_parts import finger_segments
from tracker.model.joints import FINGERS
from tracker.model.skeleton import Array

Limits = dict[str, tuple[float, float]]

LIMITS_DEG: dict[str, dict[str, dict[str, tuple[float, float]]]] = {
    "flexion": {
        "thumb": {"metacarpal": (-25.0, 40.0), "proximal": (-15.0, 60.0), "distal": (-25.0, 85.0)},
        "index": {"proximal": (-30.0, 95.0), "middle": (-10.0, 112.0), "distal": (-15.0, 85.0)},
        "middle": {"proximal": (-30.0, 95.0), "middle": (-10.0, 112.0), "distal": (-15.0, 85.0)},
        "ring": {
            "metacarpal": (-5.0, 10.0),
            "proximal": (-30.0, 95.0),
            "middle": (-10.0, 112.0),
            "distal": (-15.0, 85.0),
        },
        "little": {
            "metacarpal": (-5.0, 15.0),
            "proximal": (-35.0, 95.0),
            "middle": (-12.0, 112.0),
            "distal": (-15.0, 85.0),
        },
    },
    "abduction": {
        "thumb": {"metacarpal": (-40.0, 22.0), "proximal": (-15.0, 15.0)},
        "index": {"proximal": (-14.0, 30.0)},
        "middle": {"proximal": (-22.0, 18.0)},
        "ring": {"metacarpal": (-2.0, 2.0), "proximal": (-32.0, 12.0)},
        "little": {"metacarpal": (-4.0, 4.0), "proximal": (-50.0, 10.0)},
    },
    "twist": {
        "thumb": {"metacarpal": (-25.0, 25.0)},
        "index": {"proximal": (-6.0, 6.0)},
        "middle": {"proximal": (-6.0, 6.0)},
        "ring": {"proximal": (-6.0, 6.0)},
        "little": {"metacarpal": (-5.0, 5.0), "proximal": (-6.0, 6.0)},
    },
}
"""How far each bone turns. Flexion counts from the straight finger, abduction of the four fingers' first phalanges from
the line wrist to middle knuckle; all of twist and of `FROM_REST`, and the other abductions, from the rest pose."""

FROM_REST: frozenset[tuple[str, str]] = frozenset(
    {("thumb", "metacarpal"), ("thumb", "proximal"), ("ring", "metacarpal"), ("little", "metacarpal")}
)
"""Bones whose flexion counts from the rest pose."""

MARGIN_DEG = 4.0
"""The rest pose is at least so far from a limit of flexion or abduction that is not counted from it."""

THUMB_ROLL_DEG = 60.0
"""How far the thumb is rolled about itself against the fingers, so that it bends across the palm."""

STRAIGHT_TRUST = 0.35
"""A finger bent by this angle at rest, rad, says as much about its own plane of bending as the palm does."""


@dataclass(frozen=True)
class HandChains:
    """Where the joints of a hand are at rest, any frame, m.

    Attributes:
        side: "right" or "left".
        wrist: (3,).
        fingers: For each of FINGERS (n, 3) its joints from palm to tip: of the thumb cmc, mcp, ip, tip; of a finger the
            base of its metacarpal (may be left out), mcp, pip, dip, tip.
    """

    side: str
    wrist: Array
    fingers: dict[str, Array]

    def segments(self, finger: str) -> tuple[str, ...]:
        """Names of the bones between the joints of a finger."""
        return finger_segments(finger)[-(len(self.fingers[finger]) - 1) :]

    @property
    def forward(self) -> Array:
        """(3,) unit, from the wrist to the middle knuckle."""
        return unit(self.fingers["middle"][-4] - self.wrist)

    @property
    def dorsal(self) -> Array:
        """(3,) unit, square to `forward`, out of the back of the hand."""
        to_thumb = self.fingers["index"][-4] - self.fingers["little"][-4]
        normal = unit(np.cross(self.forward, to_thumb).astype(np.float64))
        return normal if self.side == "right" else -normal


@dataclass(frozen=True)
class HandJoint:
    """One revolute joint.

    Attributes:
        finger: One of FINGERS.
        segment: The bone that it turns.
        motion: "flexion", "abduction" or "twist".
        axis: (3,) unit, frame of the chains.
        lower: Limit, rad, from the rest pose.
        upper: Limit, rad, from the rest pose.
    """

    finger: str
    segment: str
    motion: str
    axis: Array
    lower: float
    upper: float


def derive_hand_joints(chains: HandChains) -> tuple[HandJoint, ...]:
    """Joints of all fingers, from the palm outwards: 31 when every metacarpal is there.

    A bone's joints stand in the order flexion, abduction, twist, in which they are multiplied, so that a bent
    finger can still be spread.
    """
    joints = []
    for finger in FINGERS:
        for number, segment in enumerate(chains.segments(finger)):
            axes = find_bone_axes(chains, finger, number)
            for motion, table in LIMITS_DEG.items():
                if segment in table.get(finger, {}):
                    lower, upper = table[finger][segment]
                    rest = _rest_angle(chains, finger, number, motion, axes[motion])
                    if rest is not None:
                        lower, upper = min(lower - rest, -MARGIN_DEG), max(upper - rest, MARGIN_DEG)
                    limits = np.radians([lower, upper])
                    joints.append(HandJoint(finger, segment, motion, axes[motion], float(limits[0]), float(limits[1])))
    return tuple(joints)


def find_bone_axes(chains: HandChains, finger: str, number: int) -> dict[str, Array]:
    """(3,) unit axes of flexion, abduction and twist of a finger's bone, square to each other, frame of the chains."""
    lateral, points = find_flexion_axis(chains, finger), chains.fingers[finger]
    along = unit(points[number + 1] - points[number])
    flexion = unit(lateral - (lateral @ along) * along)
    mirror = 1.0 if chains.side == "right" else -1.0
    return {"flexion": flexion, "abduction": mirror * np.cross(along, flexion), "twist": mirror * along}


def find_flexion_axis(chains: HandChains, finger: str) -> Array:
    """(3,) unit axis about which a positive turn bends the finger towards the palm.

    Square to the finger and to the back of the hand, and tilted towards the normal of the plane in which the finger is
    bent at rest, the more the further it is bent. The thumb is rolled against the fingers by THUMB_ROLL_DEG.
    """
    points = chains.fingers[finger][-4:]
    along = unit(points[3] - points[0])
    lateral = unit(np.cross(chains.dorsal, along))
    if finger == "thumb":
        roll = np.radians(-THUMB_ROLL_DEG if chains.side == "right" else THUMB_ROLL_DEG)
        lateral = np.cos(roll) * lateral + np.sin(roll) * np.cross(along, lateral)
    bones = np.diff(points, axis=0)
    bones = bones / np.linalg.norm(bones, axis=1, keepdims=True)
    bend = np.cross(bones[0], bones[1]) + np.cross(bones[1], bones[2])
    if bend @ lateral > 0.0:
        lateral = STRAIGHT_TRUST * lateral + bend
    return unit(lateral - (lateral @ along) * along)


def _rest_angle(chains: HandChains, finger: str, number: int, motion: str, axis: Array) -> float | None:
    """Degrees by which the bone is already turned at rest; None where limits count from the rest pose."""
    segment = chains.segments(finger)[number]
    if motion == "twist" or (finger, segment) in FROM_REST or (finger == "thumb" and motion == "abduction"):
        return None
    points = chains.fingers[finger]
    along = points[number + 1] - points[number]
    if segment == "proximal":
        before = chains.forward
        if motion == "flexion":
            before = along - (along @ chains.dorsal) * chains.dorsal
        else:
            along = along - (along @ chains.dorsal) * chains.dorsal
    else:
        before = points[number] - points[number - 1]
    return float(np.degrees(np.arctan2(np.cross(before, along) @ axis, before @ along)))


def unit(vector: Array) -> Array:
    """The vector (3,) at length one; zero stays zero."""
    return vector / max(float(np.linalg.norm(vector)), 1e-12)
