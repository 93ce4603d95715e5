"""Where a hand is and how it is shaped."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Self

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import Rotation

from tracker.model.blend_model import BlendModel, PosedBlend

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class HandState:
    """Pose and shape of a blend model.

    Attributes:
        pose: (B, 3) axis-angle, the root first, rad.
        shape: (S,) standard deviations.
        translation: (3,) m.
    """

    pose: Array
    shape: Array
    translation: Array

    def posed(self, model: BlendModel) -> PosedBlend:
        return model.pose_at(self.pose, self.shape, self.translation)

    def retract(self, model: BlendModel, step: Array) -> HandState:
        """The state after a step (P,) in the model's order of parameters."""
        pose, shape, translation = model.retract(self.pose, self.shape, self.translation, step)
        return HandState(pose, shape, translation)

    def moved(self, model: BlendModel, R: Array, t: Array) -> Self:
        """The state whose vertices are R v + t for the vertices v of this one; R (3, 3), t (3,) m."""
        root = model.joints_of(model.shaped(self.shape))[0]
        pose = self.pose.copy()
        pose[0] = Rotation.from_matrix(R @ Rotation.from_rotvec(pose[0]).as_matrix()).as_rotvec()
        return replace(self, pose=pose, translation=R @ (root + self.translation) + t - root)
