"""What the hands of a training share, and one of them in a pose.

A pose is held as local rotation matrices (B, 3, 3), turning a bone against its parent about its joint, and a
translation (3,); hands move as any blend model does (`blend_kernels`), but each has joints of its own.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
from scipy.sparse import csr_array
from scipy.spatial.transform import Rotation

from tracker.model.blend_kernels import BlendArrays, PosedArrays, place_into
from tracker.model.blend_model import stack_blend

Array = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Rig:
    """What all registrations share.

    Attributes:
        parents: (B,) -1 for the root, which is bone 0; a parent before its children.
        skinning_weights: (V, B) of which at most MAX_WEIGHTS a row are not zero; rows sum to one.
        directions: Pose blend shapes (V, 3, 9(B-1)), or (V, 3, 0) for none, m.
    """

    parents: npt.NDArray[np.int64]
    skinning_weights: Array
    directions: Array

    @cached_property
    def arrays(self) -> BlendArrays:
        """For the kernels; template and regressor are each hand's own."""
        num_vertices, num_bones = self.skinning_weights.shape
        nothing = csr_array((num_bones, num_vertices))
        template, unshaped = np.empty((num_vertices, 3)), np.empty((num_vertices, 3, 0))
        return stack_blend(template, unshaped, self.directions, self.skinning_weights, nothing, self.parents)


def find_features(rotations: Array) -> Array:
    """(N, 9(B-1)) elements of R_b - I of the bones but the root, of rotations (N, B, 3, 3), [R17] Eq. 4."""
    return (rotations[:, 1:] - np.eye(3)).reshape(len(rotations), -1)


@dataclass(frozen=True, eq=False)
class PosedHand:
    """A hand in a pose beside its target.

    Attributes:
        rotations: (B, 3, 3) local; translation: (3,) m.
        arrays: Where everything is.
        cost: Sum of the squared distances of vertices from the target, m².
    """

    rotations: Array
    translation: Array
    arrays: PosedArrays
    cost: float


def place(rig: Rig, template: Array, joints: Array, rotations: Array, translation: Array) -> PosedArrays:
    """A template (V, 3) with joints (B, 3), m, in the pose of local rotations (B, 3, 3) and a translation (3,)."""
    posed = PosedArrays.empty(len(template), len(joints))._replace(shaped=template, joints_rest=joints, Rs=rotations)
    place_into(posed, rig.arrays, translation)
    return posed


def place_at(rig: Rig, template: Array, joints: Array, pose: tuple[Array, Array], target: Array) -> PosedHand:
    """The same at local rotations and translation, beside a target (V, 3), m."""
    posed = place(rig, template, joints, *pose)
    return PosedHand(*pose, posed, float(np.sum((posed.vertices - target) ** 2)))


def turn(rotations: Array, translation: Array, step: Array) -> tuple[Array, Array]:
    """Local rotations (B, 3, 3) and translation (3,) after a step (3B + 3,) in the order of `blend_kernels`."""
    turns = np.concatenate([step[:3], step[6:]]).reshape(-1, 3)
    return Rotation.from_rotvec(turns).as_matrix() @ rotations, translation + step[3:6]
