"""Directions in which one hand differs from another: of a shape basis, of single bones, of a lab's marks."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from tracker.model.articulated import ArticulatedModel
from tracker.model.shape import move_at_rest
from tracker.model.skeleton import Array


@dataclass(frozen=True)
class HandDirections:
    """Linear offsets of a hand at rest; a value of 1 is about one standard deviation.

    Attributes:
        names: S names.
        vertices: (S, V, 3) offset of each vertex, model frame, m.
        joints: (S, B, 3) offset of each bone's joint, model frame, m.
        marks: (S, 21, 3) change of the hand's `joint_offsets`, model frame, m.
    """

    names: tuple[str, ...]
    vertices: Array
    joints: Array
    marks: Array

    def __post_init__(self) -> None:
        assert self.vertices.shape[0] == self.joints.shape[0] == self.marks.shape[0] == len(self.names)

    @classmethod
    def of_shape(cls, model: ArticulatedModel) -> HandDirections:
        """The model's own shape basis."""
        assert model.shape is not None, f"{model.name} has no shape basis"
        count = len(model.shape.names)
        return cls(model.shape.names, model.shape.vertices, model.shape.joints, np.zeros((count, 21, 3)))

    @classmethod
    def join(cls, parts: list[HandDirections]) -> HandDirections:
        """One behind the other."""
        return cls(
            tuple(name for part in parts for name in part.names),
            np.concatenate([part.vertices for part in parts]),
            np.concatenate([part.joints for part in parts]),
            np.concatenate([part.marks for part in parts]),
        )

    def apply(self, model: ArticulatedModel, values: Array) -> ArticulatedModel:
        """The model moved along the directions by values (S,); its shape basis stays as it is."""
        assert values.shape == (len(self.names),) and model.hand is not None
        marks = model.hand.joint_offsets + np.einsum("s,sjx->jx", values, self.marks)
        moved = move_at_rest(model, values, self.vertices, self.joints)
        return replace(moved, hand=replace(model.hand, joint_offsets=marks))

    def of_landmarks(self, model: ArticulatedModel) -> Array:
        """(S, 21, 3) offset of each landmark, model frame, m."""
        assert model.hand is not None
        bones, vertices = model.hand.joint_bones, model.hand.joint_vertices
        at_bone = (bones >= 0)[:, None]
        return np.where(at_bone, self.joints[:, bones], self.vertices[:, vertices]) + self.marks
