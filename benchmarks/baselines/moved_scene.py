"""The vertices of a scene at one pose after another."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from tracker.model.kinematics import move_bones_into
from tracker.model.scene import Scene
from tracker.model.skinning import skin_into

Array = npt.NDArray[np.float64]


class MovedScene:
    """Poses a scene without normals and derivatives, into buffers used again for every pose."""

    def __init__(self, scene: Scene) -> None:
        arrays = scene.arrays
        self.scene = scene
        self.Ms = np.zeros((len(arrays.parents), 3, 4))
        self.twists = np.zeros((scene.num_dofs, 6))
        self.vertices = np.zeros((len(arrays.vertices), 3))
        self.bone_vertices = np.zeros((0, arrays.weights.shape[1], 3))

    def move(self, pose: Array) -> Array:
        """Vertices (V, 3) world, m, landmarks behind, at the pose (D,); the next call writes over them."""
        arrays = self.scene.arrays
        move_bones_into(self.Ms, self.twists, arrays, pose)
        skin_into(self.vertices, self.bone_vertices, self.scene.surface_at(self.Ms), arrays, self.Ms)
        return self.vertices
