"""Where an image shows the finger nails of posed hands."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.geometry import se3
from tracker.model.nails import find_nails
from tracker.model.scene import Scene

Array = npt.NDArray[np.float64]

FACING = 0.3
"""Cosine between a nail's normal and the way to the camera; of one that is seen flatter there is too little."""

AWAY = -0.2
"""The same of a nail of whose rim there may yet be something to see."""

BEHIND = 0.002
"""m; a nail that lies so much behind what is drawn there is hidden."""


@dataclass(frozen=True)
class NailPlaces:
    """The middles of all nails of a scene, as surface points.

    Attributes:
        ids: (N, 3) vertices of the scene.
        shares: (N, 3) theirs in the point.
    """

    ids: npt.NDArray[np.int32]
    shares: Array

    @classmethod
    def of(cls, scene: Scene) -> NailPlaces:
        """Five of each hand, thumb first, hands in the scene's order."""
        ids, shares = [], []
        for model, where in zip(scene.models, scene.vertex_slices, strict=True):
            for nail in find_nails(model) if model.hand else ():
                ids.append(nail.corners + where.start)
                shares.append(nail.shares)
        return cls(np.array(ids, dtype=np.int32).reshape(-1, 3), np.array(shares).reshape(-1, 3))

    def points(self, vertices: Array) -> Array:
        """(N, 3) world, m, of the scene's vertices (V, 3) world, m."""
        return np.einsum("nc,nci->ni", self.shares, vertices[self.ids])

    def find_flat(self, vertices: Array, camera: Camera) -> npt.NDArray[np.bool_]:
        """(N,) which nails are seen so flat that an image may show something of their rims, or nothing.

        Args:
            vertices: (V, 3) of the scene, world, m.
            camera: Without distortion.
        """
        facing = self._find_facing(vertices, camera)
        return (facing > AWAY) & (facing <= FACING)

    def find_visible(self, vertices: Array, camera: Camera, depth: Array, first: Array) -> npt.NDArray[np.bool_]:
        """(N,) which nails are turned to a camera and nothing hides.

        Args:
            vertices: (V, 3) of the scene, world, m.
            camera: Without distortion.
            depth: (H, W) of the drawn scene, m, 0 where nothing is; the whole image or a part of it.
            first: (2,) column and row of its first pixel.
        """
        points = se3.transform(camera.T_camera_world, self.points(vertices))
        z = np.maximum(points[:, 2], 1e-6)
        pixels = points[:, :2] / z[:, None] * camera.K[[0, 1], [0, 1]] + camera.K[:2, 2]
        height, width = depth.shape
        columns, rows = np.rint(np.clip(pixels - first, -1.0, [width, height])).astype(np.int64).T
        inside = (points[:, 2] > 0.0) & (columns >= 0) & (rows >= 0) & (columns < width) & (rows < height)
        drawn = depth[np.clip(rows, 0, height - 1), np.clip(columns, 0, width - 1)]
        is_turned = self._find_facing(vertices, camera) > FACING
        return is_turned & inside & ((drawn <= 0.0) | (z < drawn + BEHIND))

    def _find_facing(self, vertices: Array, camera: Camera) -> Array:
        """(N,) cosine between each nail's normal and the way to a camera."""
        a, b, c = (vertices[self.ids[:, corner]] for corner in range(3))
        normals = np.cross(b - a, c - a)
        towards = camera.T_world_camera[:3, 3] - self.points(vertices)
        lengths = np.linalg.norm(normals, axis=1) * np.linalg.norm(towards, axis=1)
        return np.einsum("ni,ni->n", normals, towards) / np.maximum(lengths, 1e-12)
