"""A skinned mesh with a skeleton: hand, ball, cube, pipe or rope, [T16] §3.1."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import numpy.typing as npt

from tracker.geometry.triangles import is_watertight
from tracker.model.pose_blend import PoseBlend
from tracker.model.skeleton import Array, Skeleton


@dataclass(frozen=True)
class HandParts:
    """What makes a model a hand.

    Attributes:
        side: "right" or "left".
        joint_bones: (21,) for each of HAND_JOINTS the bone whose joint it is, -1 where a vertex is meant.
        joint_vertices: (21,) for each of HAND_JOINTS the vertex it is, -1 where a bone is meant.
        fingertips: thumb..little, the vertex ids of each fingertip, [T16] Fig. 2 d-f.
        finger_parts: name such as "index_distal" to vertex ids, [T16] Fig. 10.
        joint_offsets: (21, 3) from each of those bones' joints or vertices to where annotators of the recording put the
            joint, model frame at rest, m. They move with the bone and turn nothing.
    """

    side: str
    joint_bones: npt.NDArray[np.int64]
    joint_vertices: npt.NDArray[np.int64]
    fingertips: tuple[npt.NDArray[np.int64], ...]
    finger_parts: dict[str, npt.NDArray[np.int64]]
    joint_offsets: Array = field(default_factory=lambda: np.zeros((21, 3)))

    def __post_init__(self) -> None:
        assert self.joint_offsets.shape == (21, 3)


@dataclass(frozen=True)
class ShapeBasis:
    """Linear offsets that change who the hand belongs to.

    Attributes:
        names: S names, "size" first.
        vertices: (S, V, 3) offset of each vertex per unit, model frame, m.
        joints: (S, B, 3) offset of each bone's joint per unit, model frame, m.
        lower: (S,) smallest sensible value.
        upper: (S,) largest sensible value.
    """

    names: tuple[str, ...]
    vertices: Array
    joints: Array
    lower: Array
    upper: Array


@dataclass(frozen=True)
class ArticulatedModel:
    """A triangle mesh moved by linear blend skinning, [T16] Eq. 1.

    Attributes:
        name: For people.
        vertices: (V, 3) rest pose, model frame, m. A vertex that no face uses is allowed: a fingertip kept as a mark.
        faces: (F, 3) counter-clockwise seen from outside.
        skinning_weights: (V, B) rows sum to one, at most MAX_WEIGHTS non-zero.
        skeleton: Bones and revolute joints.
        hand: Hand landmarks, or None for an object.
        shape: Shape basis, or None where the shape is fixed.
        provenance: Where the model came from, licence, what was done to it.
        pose_blend: How its surface changes with the pose, or None where it is only skinned.
    """

    name: str
    vertices: Array
    faces: npt.NDArray[np.int64]
    skinning_weights: Array
    skeleton: Skeleton
    hand: HandParts | None = None
    shape: ShapeBasis | None = None
    provenance: dict[str, str] = field(default_factory=dict)
    pose_blend: PoseBlend | None = None

    def __post_init__(self) -> None:
        num_vertices = len(self.vertices)
        assert self.vertices.shape == (num_vertices, 3)
        assert self.faces.ndim == 2 and self.faces.shape[1] == 3
        assert self.skinning_weights.shape == (num_vertices, self.skeleton.num_bones)
        assert self.pose_blend is None or len(self.pose_blend.directions) == num_vertices

    @property
    def num_dofs(self) -> int:
        return self.skeleton.num_dofs

    @cached_property
    def is_closed(self) -> bool:
        """Whether the mesh has no hole, so that its inside is never seen."""
        return is_watertight(self.faces)
