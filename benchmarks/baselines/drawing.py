"""What cameras see of moving surfaces, drawn over and over."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.geometry import se3
from tracker.model.scene import Scene
from tracker.rendering.zbuffer import project_into, rasterize_into

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Canvas:
    """What is drawn on.

    Attributes:
        K: (3, 3) px, without distortion.
        T_world_camera: (4, 4).
        shape: Rows and columns.
    """

    K: Array
    T_world_camera: Array
    shape: tuple[int, int]


class Drawing:
    """The drawing of `render_view` without normals, into buffers used again for every pose and every canvas.

    Attributes:
        inverse_depth: (H, W) drawn last, 1/m; 0 where nothing is.
        face: (H, W) face drawn last, -1 where none is.
    """

    def __init__(self, scene: Scene, canvases: tuple[Canvas, ...]) -> None:
        count, most = len(scene.arrays.vertices), max(canvas.shape[0] * canvas.shape[1] for canvas in canvases)
        self.scene, self.canvases = scene, canvases
        self._in_camera, self._projected = np.zeros((count, 3)), np.zeros((count, 3))
        self._turns = [np.ascontiguousarray(canvas.T_world_camera[:3, :3]) for canvas in canvases]
        self._shifts = [se3.inverse(canvas.T_world_camera)[:3, 3] for canvas in canvases]
        self._inverse_depth, self._face = np.zeros(most), np.zeros(most, dtype=np.int32)
        self.inverse_depth, self.face = np.zeros((0, 0)), np.zeros((0, 0), dtype=np.int32)

    def draw(self, vertices: Array, number: int = 0) -> None:
        """Draw the scene with its vertices at (V, 3) world, m, on one of the canvases."""
        K, shape = self.canvases[number].K, self.canvases[number].shape
        self.inverse_depth = self._inverse_depth[: shape[0] * shape[1]].reshape(shape)
        self.face = self._face[: shape[0] * shape[1]].reshape(shape)
        self.inverse_depth.fill(0.0)
        self.face.fill(-1)
        np.dot(vertices, self._turns[number], out=self._in_camera)
        self._in_camera += self._shifts[number]
        project_into(self._projected, self._in_camera, K[0, 0], K[1, 1], K[0, 2], K[1, 2])
        faces = self.scene.arrays.faces
        rasterize_into(self.inverse_depth, self.face, self._projected, faces, self.scene.open_faces)
