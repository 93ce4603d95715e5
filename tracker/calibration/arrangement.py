"""Cameras and places of a board, the corners that were seen, and how far apart the two are in the pictures."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.calibration.projection import project_points
from tracker.geometry.se3 import transform

Array = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Corners:
    """M corners that were seen.

    Attributes:
        camera: (M,) number of the camera, ascending.
        moment: (M,) number of the board's place.
        points: (M, 3) board, m.
        pixels: (M, 2) px where it was seen.
        velocity: (M, 2) px/s.
    """

    camera: Integers
    moment: Integers
    points: Array
    pixels: Array
    velocity: Array

    def choose(self, mask: npt.NDArray[np.bool_]) -> Corners:
        """Those of a mask (M,)."""
        return Corners(self.camera[mask], self.moment[mask], self.points[mask], self.pixels[mask], self.velocity[mask])


@dataclass(frozen=True, eq=False)
class Arrangement:
    """C cameras and B places of the board.

    Attributes:
        K: (C, 3, 3) px.
        distortion: (C, 12) OpenCV's, zeros where there is none.
        T_camera_world: (C, 4, 4) m.
        T_world_board: (B, 4, 4) m.
        offsets: (C,) s, relative to where the corners were read.
        sizes: (C, 2) px, of the pictures.
    """

    K: Array
    distortion: Array
    T_camera_world: Array
    T_world_board: Array
    offsets: Array
    sizes: Array

    def find_centres(self) -> Array:
        """(C, 3) world, m, of the cameras."""
        return -np.einsum("cji,cj->ci", self.T_camera_world[:, :3, :3], self.T_camera_world[:, :3, 3])

    def find_baselines(self) -> Array:
        """(C,) m, from the first camera to each."""
        centres = self.find_centres()
        return np.linalg.norm(centres - centres[0], axis=1)

    def residuals(self, corners: Corners) -> Array:
        """(M, 2) px, projected minus seen. Behind a camera they are large."""
        world = _transform(self.T_world_board[corners.moment], corners.points)
        edges = np.searchsorted(corners.camera, np.arange(len(self.K) + 1))
        pixels = np.empty_like(corners.pixels)
        for number, T in enumerate(self.T_camera_world):
            own = slice(edges[number], edges[number + 1])
            pixels[own] = project_points(transform(T, world[own]), self.K[number], self.distortion[number])
        return pixels - corners.pixels - self.offsets[corners.camera, None] * corners.velocity


def _transform(T: Array, points: Array) -> Array:
    """Points (M, 3), each moved by its own T (M, 4, 4)."""
    return np.einsum("mij,mj->mi", T[:, :3, :3], points) + T[:, :3, 3]
