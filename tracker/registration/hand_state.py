"""Where a hand is and how it is shaped."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

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
