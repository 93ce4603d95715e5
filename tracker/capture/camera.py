"""A pinhole camera with OpenCV distortion; pixel centres are integers."""

from __future__ import annotations

from dataclasses import dataclass, field

import cv2
import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

UNDISTORTION_STEPS = 8
"""Of Newton's method; three are enough inside an ordinary image."""

SETTLED_PX = 1e-9
"""Newton's method ends when every ray meets its pixel so nearly: another step would move it by rounding."""

MEETING_PX = 1e-4
"""A ray meets its pixel if it comes so near."""


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

    def unproject(self, pixels: Array) -> Array:
        """Rays (N, 3) camera, with z = 1, that `project` sends to (N, 2) px.

        OpenCV's guess is refined until the ray meets its pixel again. A pixel that no ray meets, beyond where the
        distortion folds over, comes out as NaN.
        """
        assert pixels.ndim == 2 and pixels.shape[1] == 2
        if self.distortion.size == 0 or len(pixels) == 0:
            K = self.K
            return np.column_stack([(pixels - K[:2, 2]) / [K[0, 0], K[1, 1]], np.ones(len(pixels))])
        guess = cv2.undistortPoints(pixels[:, None, :].astype(np.float64), self.K, self.distortion)[:, 0, :]
        rays = np.column_stack([guess.astype(np.float64), np.ones(len(guess))])
        with np.errstate(invalid="ignore", divide="ignore"):
            here, J = self._distort(rays)
            for _ in range(UNDISTORTION_STEPS):
                off = pixels - here
                if np.nanmax(np.abs(off), initial=0.0) < SETTLED_PX:
                    break
                determinant = J[:, 0, 0] * J[:, 1, 1] - J[:, 0, 1] * J[:, 1, 0]
                rays[:, 0] += (J[:, 1, 1] * off[:, 0] - J[:, 0, 1] * off[:, 1]) / determinant
                rays[:, 1] += (J[:, 0, 0] * off[:, 1] - J[:, 1, 0] * off[:, 0]) / determinant
                rays[~(determinant > 0.0), :2] = np.nan
                here, J = self._distort(rays)
            rays[~(np.linalg.norm(here - pixels, axis=1) < MEETING_PX)] = np.nan
        return rays

    def lift(self, pixels: npt.NDArray[np.number], depths: Array) -> Array:
        """Points (N, 3) world, m, seen at (N, 2) px and at depths (N,), m along the camera's axis."""
        R, t = self.T_world_camera[:3, :3], self.T_world_camera[:3, 3]
        return (self.unproject(pixels.astype(np.float64)) * depths[:, None]) @ R.T + t

    def can_see(self, points_world: Array) -> npt.NDArray[np.bool_]:
        """Whether (N, 3) world, m, are in the image (N,): the pixel lies in it, and its ray leads back to the point."""
        pixels = self.project(points_world)
        with np.errstate(invalid="ignore"):
            is_inside = np.all((pixels >= -0.5) & (pixels < np.array([self.width, self.height]) - 0.5), axis=1)
        T = self.T_camera_world
        points_camera = points_world[is_inside] @ T[:3, :3].T + T[:3, 3]
        rays = self.unproject(pixels[is_inside])
        with np.errstate(invalid="ignore"):
            is_inside[is_inside] = np.all(np.abs(rays - points_camera / points_camera[:, 2:]) < 1e-3, axis=1)
        return is_inside

    def _distort(self, rays: Array) -> tuple[Array, Array]:
        """Pixels (N, 2) of rays (N, 3), camera, with z = 1, and their derivatives by x and y (N, 2, 2)."""
        pixels, by_parameters = cv2.projectPoints(rays[:, None], np.zeros(3), np.zeros(3), self.K, self.distortion)
        # A camera that is moved sees what moved rays would show.
        by_translation = np.asarray(by_parameters[:, 3:5], dtype=np.float64)
        return np.asarray(pixels[:, 0], dtype=np.float64), by_translation.reshape(-1, 2, 2)
