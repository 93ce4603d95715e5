"""What every hand has in common, as the checks need it."""

from __future__ import annotations

from functools import cache

import numpy as np
import numpy.typing as npt

FINGERS = ("thumb", "index", "middle", "ring", "little")
EDGES = np.array(
    [
        [a, b]
        for f in range(5)
        for a, b in zip((0, *range(1 + 4 * f, 4 + 4 * f)), range(1 + 4 * f, 5 + 4 * f), strict=True)
    ]
)
"""(20, 2) joints that a bone connects: wrist to the base of each finger, then along it."""

KNUCKLES = np.array([5, 9, 13, 17])


@cache
def find_bone_lengths() -> npt.NDArray[np.float64]:
    """(20,) length of each of EDGES in the default hand, m."""
    from tracker import default_hand

    model = default_hand("right")
    hand = model.hand
    assert hand is not None
    at_bone = (hand.joint_bones >= 0)[:, None]
    joints = np.where(at_bone, model.skeleton.joints_rest[hand.joint_bones], model.vertices[hand.joint_vertices])
    return np.linalg.norm(joints[EDGES[:, 0]] - joints[EDGES[:, 1]], axis=1)


def joint_name(joint: int) -> str:
    """Such as "index pip"."""
    from tracker import HAND_JOINTS

    return str(HAND_JOINTS[joint]).replace("_", " ")
