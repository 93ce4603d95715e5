"""The poses at which a mirrored hand shows the mirror image of a hand."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from tracker.geometry import se3
from tracker.model.mirroring import MIRROR

Array = npt.NDArray[np.float64]


def mirror_pose(pose: Array) -> Array:
    """The pose (D,) of the mirrored model that shows the mirror image, in the plane y = 0 of the world."""
    T = se3.exp(np.ascontiguousarray(pose[:6]))
    reflection = np.array([*MIRROR, 1.0])
    return np.concatenate([se3.log(T * np.outer(reflection, reflection)), pose[6:]])


def mirror_blend_pose(pose: Array, reflection: Array = MIRROR) -> Array:
    """Rotation vectors (..., 3) of the mirrored hand that show the mirror image; translations are reflected."""
    return -pose * reflection
