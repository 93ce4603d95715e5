"""What can be chosen about training a hand model."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from tracker.errors import TrainingError
from tracker.training.pose_shapes import RIDGE


@dataclass(frozen=True)
class TrainingOptions:
    """Attributes:
    name: Of the model.
    rounds: Times that templates, joints, weights and blend shapes are improved in turn.
    with_pose_shapes: Without, what is trained is plain linear blend skinning.
    with_mirrored: Whether mirrored left hands are learnt from, too.
    ridge: Weight of Eq. 10, per registration.
    num_shapes: Shape directions of the whole hand kept, at most.
    num_local_shapes: Shape directions of parts of the hand that follow them, at most (`local_shapes`).
    joint_stiffness: How strongly joints keep to the joint regressor, in vertices per registration.
    weight_stiffness: How strongly blend weights keep to what they were, mm².
    threads: Poses fitted at a time.
    """

    name: str = "trained hand"
    rounds: int = 3
    with_pose_shapes: bool = True
    with_mirrored: bool = True
    ridge: float = RIDGE
    num_shapes: int = 10
    num_local_shapes: int = 0
    joint_stiffness: float = 2.0
    weight_stiffness: float = 0.1
    threads: int = 1

    def __post_init__(self) -> None:
        if not 1 <= self.rounds <= 20:
            raise TrainingError(f"rounds is {self.rounds}; it must be from 1 to 20.")
        if not 0.0 < self.ridge < np.inf:
            raise TrainingError(f"ridge is {self.ridge}; it must be a finite number above 0.")
        if not 1 <= self.num_shapes <= 200:
            raise TrainingError(f"num_shapes is {self.num_shapes}; it must be from 1 to 200.")
        if not 0 <= self.num_local_shapes <= 200:
            raise TrainingError(f"num_local_shapes is {self.num_local_shapes}; it must be from 0 to 200.")
        if self.joint_stiffness <= 0.0 or self.weight_stiffness <= 0.0:
            raise TrainingError("joint_stiffness and weight_stiffness must be above 0.")
        if not 1 <= self.threads <= 256:
            raise TrainingError(f"threads is {self.threads}; it must be from 1 to 256.")

    def describe(self) -> dict[str, Any]:
        """For a report; how many threads did it is left out, for the result does not depend on it."""
        described = asdict(self)
        del described["threads"]
        return described
