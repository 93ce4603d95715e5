"""What a camera sees of moving surfaces, drawn over and over."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from tracker.geometry import se3
from tracker.model.scene import Scene
from tracker.rendering.zbuffer import project_into, rasterize_into

Array = npt.NDArray[np.float64]


class Drawing:
    """The drawing of `render_view` without normals, into buffers used again for every pose.

    Attributes:
        inverse_depth: (H, W) drawn, 1/m; 0 where nothing is.
        face: (H, W) drawn face, -1 where none is.
    """

    def __init__(self, scene: Scene, K: Array, T_world_camera: Array, shape: tuple[int, int]) -> None:
        self.scene, self.K = scene, K
        self.T_camera_world = se3.inverse(T_world_camera)
        self.projected = np.zeros((len(scene.arrays.vertices), 3))
        self.inverse_depth = np.zeros(shape)
        self.face = np.full(shape, -1, dtype=np.int32)

    def draw(self, vertices: Array) -> None:
        """Draw the scene with its vertices at (V, 3) world, m, over what was drawn before."""
        K = self.K
        self.inverse_depth.fill(0.0)
        self.face.fill(-1)
        in_camera = vertices @ self.T_camera_world[:3, :3].T + self.T_camera_world[:3, 3]
        project_into(self.projected, in_camera, K[0, 0], K[1, 1], K[0, 2], K[1, 2])
        faces = self.scene.arrays.faces
        rasterize_into(self.inverse_depth, self.face, self.projected, faces, self.scene.open_faces)
