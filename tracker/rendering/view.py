"""A posed scene as one camera region sees it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from numba import njit

from tracker.geometry import se3
from tracker.model.scene import PosedScene
from tracker.rendering.zbuffer import project_into, rasterize_into

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class View:
    """A posed scene drawn through a pinhole camera.

    Attributes:
        posed: The scene.
        K: (3, 3) px.
        T_camera_world: (4, 4).
        projected: (V, 3) column px, row px, inverse depth 1/m (0 = not in front).
        inverse_depth: (H, W) 1/m, 0 where nothing is.
        face: (H, W) int32 nearest face, -1 where nothing is.
        face_normals: (F, 3) unit, world.
    """

    posed: PosedScene
    K: Array
    T_camera_world: Array
    projected: Array
    inverse_depth: Array
    face: npt.NDArray[np.int32]
    face_normals: Array

    @property
    def depth(self) -> Array:
        """(H, W) m, 0 where nothing is."""
        return np.where(self.face >= 0, 1.0 / np.maximum(self.inverse_depth, 1e-9), 0.0)


def render_view(posed: PosedScene, K: Array, T_world_camera: Array, height: int, width: int) -> View:
    """Draw a posed scene through K (3, 3) px into (height, width) px."""
    T = se3.inverse(T_world_camera)
    faces = posed.scene.arrays.faces
    projected = np.zeros((len(posed.vertices), 3))
    inverse_depth = np.zeros((height, width))
    face = np.full((height, width), -1, dtype=np.int32)
    face_normals = np.zeros((len(faces), 3))
    vertices_camera = posed.vertices @ T[:3, :3].T + T[:3, 3]
    project_into(projected, vertices_camera, K[0, 0], K[1, 1], K[0, 2], K[1, 2])
    rasterize_into(inverse_depth, face, projected, faces, posed.scene.open_faces)
    _face_normals_into(face_normals, posed.vertices, faces)
    return View(posed, K, T, projected, inverse_depth, face, face_normals)


@njit(cache=True, nogil=True)
def _face_normals_into(normals, vertices, faces):
    for f in range(len(faces)):
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        ux, uy, uz = vertices[b, 0] - vertices[a, 0], vertices[b, 1] - vertices[a, 1], vertices[b, 2] - vertices[a, 2]
        wx, wy, wz = vertices[c, 0] - vertices[a, 0], vertices[c, 1] - vertices[a, 1], vertices[c, 2] - vertices[a, 2]
        nx, ny, nz = uy * wz - uz * wy, uz * wx - ux * wz, ux * wy - uy * wx
        length = np.sqrt(nx * nx + ny * ny + nz * nz)
        if length > 0.0:
            normals[f, 0], normals[f, 1], normals[f, 2] = nx / length, ny / length, nz / length
