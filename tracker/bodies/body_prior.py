"""What is known of a body's pose before the scan is seen: Eq. 16 of [R17] with a deviation for every axis."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from tracker.model.body_hands import NUM_BODY_JOINTS
from tracker.model.mano_files import BODY_JOINTS
from tracker.registration.pose_prior import PosePrior

Array = npt.NDArray[np.float64]

DEVIATION_DEG: dict[str, tuple[float, float, float]] = {
    "hip": (35, 18, 15),
    "knee": (35, 6, 5),
    "ankle": (15, 12, 8),
    "foot": (10, 4, 4),
    "spine": (12, 10, 10),
    "neck": (15, 20, 12),
    "head": (12, 15, 10),
    "collar": (5, 10, 10),
    "shoulder": (35, 40, 45),
    "elbow": (35, 50, 6),
    "wrist": (15, 20, 30),
}
"""Of a joint's turn about x, y and z of the T-pose, degrees: what bodies do in everyday poses, roughly."""

LIMITS_DEG: dict[str, tuple[int, float, float]] = {
    "left_knee": (0, -5.0, 150.0),
    "right_knee": (0, -5.0, 150.0),
    "left_elbow": (1, -150.0, 5.0),
    "right_elbow": (1, -5.0, 150.0),
}
"""Hinges: the axis about which each bends, and how far, degrees."""


def make_body_prior() -> PosePrior:
    """Of the 21 joints behind the root, about the pose with lowered arms; knees and elbows bend one way only.

    Differs from the paper: E_θ = |θ|² holds knees as hard as it holds the twist of a spine.
    """
    joints = BODY_JOINTS[1:]
    deviation = np.radians([_of_kind(name) for name in joints])
    mean = np.zeros((len(joints), 3))
    for side, sign in (("left", -1.0), ("right", 1.0)):
        mean[joints.index(f"{side}_shoulder"), 2] = sign * np.radians(35.0)
        mean[joints.index(f"{side}_elbow"), 1] = sign * np.radians(25.0)
    mean[joints.index("left_knee"), 0] = mean[joints.index("right_knee"), 0] = np.radians(10.0)
    size = 3 * (NUM_BODY_JOINTS - 1)
    rows, low, high = [], [], []
    for name, (axis, least, most) in LIMITS_DEG.items():
        row = np.zeros(size)
        row[3 * joints.index(name) + axis] = 1.0
        rows.append(row)
        low.append(np.radians(least))
        high.append(np.radians(most))
    return PosePrior(
        mean=mean.ravel(),
        root=np.diag(1.0 / deviation.ravel()),
        axes=np.array(rows),
        low=np.array(low),
        high=np.array(high),
    )


def _of_kind(name: str) -> tuple[float, float, float]:
    kind = name.removeprefix("left_").removeprefix("right_").rstrip("123")
    return DEVIATION_DEG[kind]
