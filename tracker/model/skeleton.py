"""A kinematic skeleton of bones and revolute joints, [T16] §3.1."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Skeleton:
    """Bones in topological order and the revolute joints that turn them, [T16] Eq. 4.

    The motion of bone j is T_j(θ) T_j(0)^-1 = exp(root) · Π exp(θ_k ξ_k) over the joints k on the way from the root to
    j, every ξ_k a unit twist of the rest pose in the model frame. Joints of one bone are multiplied in the order they
    have here.

    Attributes:
        bone_names: B names.
        parents: (B,) index of the parent, -1 for the root; a parent comes before its children.
        Ts_model_bone: (B, 4, 4) rest pose of each bone, bone to model frame, m; its translation is the bone's joint.
        dof_bones: (K,) the bone that joint k turns.
        dof_axes: (K, 3) unit axis at rest, model frame; the axis passes through the bone's joint.
        lower: (K,) lower limit, rad.
        upper: (K,) upper limit, rad.
    """

    bone_names: tuple[str, ...]
    parents: npt.NDArray[np.int64]
    Ts_model_bone: Array
    dof_bones: npt.NDArray[np.int64]
    dof_axes: Array
    lower: Array
    upper: Array

    def __post_init__(self) -> None:
        bones, dofs = len(self.bone_names), len(self.dof_bones)
        assert self.parents.shape == (bones,)
        assert self.Ts_model_bone.shape == (bones, 4, 4)
        assert self.dof_axes.shape == (dofs, 3)
        assert self.lower.shape == self.upper.shape == (dofs,)
        assert np.all(self.parents < np.arange(bones)), "a parent must come before its children"

    @classmethod
    def of_one_bone(cls, name: str, joint: Array) -> Skeleton:
        """A rigid thing's: one bone that turns about a joint (3,), model frame, m."""
        T, none = np.eye(4), np.zeros(0)
        T[:3, 3] = joint
        return cls((name,), np.array([-1]), T[None], np.zeros(0, dtype=np.int64), np.zeros((0, 3)), none, none)

    @property
    def num_bones(self) -> int:
        return len(self.bone_names)

    @property
    def num_dofs(self) -> int:
        """Degrees of freedom with the six of the root, D."""
        return 6 + len(self.dof_bones)

    @property
    def joints_rest(self) -> Array:
        """(B, 3) joints at rest, model frame, m."""
        return self.Ts_model_bone[:, :3, 3]
