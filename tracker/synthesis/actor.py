"""A model and its known motion: who acts in a synthetic recording."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.model.articulated import ArticulatedModel
from tracker.model.joints import HAND_JOINTS

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Actor:
    """One hand or object with its motion at T moments.

    Attributes:
        name: "right" or "left" for a hand, the object's name otherwise.
        model: The surface that is rendered.
        Ms: (T, B, 3, 4) motion of each bone from rest to world at every moment, m; T_j(θ) T_j(0)^-1 of [T16] Eq. 1.
        albedo: (3,) RGB in 0..1 of the surface, linear light.
    """

    name: str
    model: ArticulatedModel
    Ms: Array
    albedo: tuple[float, float, float]

    def __post_init__(self) -> None:
        assert self.Ms.shape == (len(self.Ms), self.model.skeleton.num_bones, 3, 4)

    @property
    def is_hand(self) -> bool:
        return self.model.hand is not None

    @property
    def num_moments(self) -> int:
        return len(self.Ms)

    @property
    def joint_names(self) -> tuple[str, ...]:
        """As in `track.npz`: `right/index_mcp`; for an articulated object `rope:<bone>`; none for a rigid one."""
        if self.is_hand:
            return tuple(f"{self.name}/{joint}" for joint in HAND_JOINTS)
        bones = self.model.skeleton.bone_names
        return tuple(f"{self.name}:{bone}" for bone in bones) if len(bones) > 1 else ()

    def vertices(self, moment: int) -> Array:
        """(V, 3) world, m, by linear blend skinning."""
        blended = (self.model.skinning_weights @ self.Ms[moment].reshape(-1, 12)).reshape(-1, 3, 4)
        return np.einsum("vij,vj->vi", blended[:, :, :3], self.model.vertices) + blended[:, :, 3]

    def joints(self, moment: int, vertices: Array) -> Array:
        """(J, 3) world, m, in the order of `joint_names`; `vertices` (V, 3) are those of the same moment."""
        if not self.joint_names:
            return np.zeros((0, 3))
        M = self.Ms[moment]
        bones = np.einsum("bij,bj->bi", M[:, :, :3], self.model.skeleton.joints_rest) + M[:, :, 3]
        hand = self.model.hand
        if hand is None:
            return bones
        joints = np.where((hand.joint_bones >= 0)[:, None], bones[hand.joint_bones], vertices[hand.joint_vertices])
        blended = (self.model.skinning_weights[hand.joint_vertices] @ M.reshape(-1, 12)).reshape(-1, 3, 4)
        turns = np.where((hand.joint_bones >= 0)[:, None, None], M[hand.joint_bones][:, :, :3], blended[:, :, :3])
        return joints + np.einsum("jik,jk->ji", turns, hand.joint_offsets)

    def T_world_model(self, moment: int) -> Array:
        """(4, 4) the root's motion: coordinates of the model's file to world, m."""
        T = np.eye(4)
        T[:3] = self.Ms[moment, 0]
        return T
