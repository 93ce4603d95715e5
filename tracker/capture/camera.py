"""A pinhole camera with OpenCV distortion; pixel centres are integers."""

from __future__ import annotations

from dataclasses import dataclass, field

import cv2
import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Camera:
    """One calibrated camera (+X right, +Y down, +Z forward).

    Attributes:
        id: As in `sequence.json`.
        width: px.
        height: px.
        K: (3, 3) px.
        distortion: (n,) OpenCV coefficients, empty for none.
        T_world_camera: (4, 4) camera to world, m.
    """

    id: str
    width: int
    height: int
    K: Array
    distortion: Array = field(default_factory=lambda: np.zeros(0))
    T_world_camera: Array = field(default_factory=lambda: np.eye(4))

    @property
    def T_camera_world(self) -> Array:
        """(4, 4) world to camera, m."""
        R, t = self.T_world_camera[:3, :3], self.T_world_camera[:3, 3]
        T = np.eye(4)
        T[:3, :3] = R.T
        T[:3, 3] = -R.T @ t
        return T

    def project(self, points_world: Array) -> Array:
        """Project (N, 3) world, m, to (N, 2) px. Points behind the camera come out as NaN."""
        assert points_world.ndim == 2 and points_world.shape[1] == 3
        if len(points_world) == 0:
            return np.zeros((0, 2))
        T = self.T_camera_world
        points_camera = points_world @ T[:3, :3].T + T[:3, 3]
        pixels = cv2.projectPoints(
            points_camera[:, None, :],
            np.zeros(3),
            np.zeros(3),
            self.K,
            self.distortion if self.distortion.size else None,
        )[0][:, 0, :].astype(np.float64)
        pixels[points_camera[:, 2] <= 0] = np.nan
        return pixels
