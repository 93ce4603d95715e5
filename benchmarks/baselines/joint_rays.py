"""Detected joints of several views, to measure many poses against."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from numba import njit

from benchmarks.baselines.discrepancy import CUT
from tracker.fitting.view_hands import ViewHands
from tracker.model.scene import Scene

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class JointRays:
    """The viewing ray of every joint that a view shows.

    Attributes:
        ids: (N,) landmarks among the scene's vertices.
        origins: (N, 3) of the camera, world, m.
        directions: (N, 3) unit, world.
    """

    ids: npt.NDArray[np.int64]
    origins: Array
    directions: Array

    @classmethod
    def of(cls, scene: Scene, seen: ViewHands, names: tuple[str, ...]) -> JointRays:
        """Of all hands in all views; names are those of the scene's models."""
        ids, origins, directions = [np.zeros(0, dtype=np.int64)], [np.zeros((0, 3))], [np.zeros((0, 3))]
        for camera, hands in zip(seen.cameras, seen.hands, strict=True):
            for model, name in enumerate(names):
                if name not in hands:
                    continue
                rays = camera.unproject(hands[name].points) @ camera.T_world_camera[:3, :3].T
                joints = np.flatnonzero(np.isfinite(rays).all(axis=1))
                ids.append(scene.landmark_slices[model].start + joints)
                origins.append(np.tile(camera.T_world_camera[:3, 3], (len(joints), 1)))
                directions.append(rays[joints] / np.linalg.norm(rays[joints], axis=1, keepdims=True))
        return cls(np.concatenate(ids), np.concatenate(origins), np.concatenate(directions))

    def measure(self, vertices: Array) -> float:
        """Mean distance of the joints of vertices (V, 3), world, m, from their rays, mm; each counts at most `CUT`."""
        return measure_rays(vertices, self.ids, self.origins, self.directions)


@njit(cache=True, nogil=True)
def measure_rays(vertices: Array, ids: npt.NDArray[np.int64], origins: Array, directions: Array) -> float:
    """As `JointRays.measure`; 0 without rays."""
    total = 0.0
    for n in range(len(ids)):
        x, y, z = vertices[ids[n]] - origins[n]
        u, v, w = directions[n]
        across = np.sqrt((y * w - z * v) ** 2 + (z * u - x * w) ** 2 + (x * v - y * u) ** 2)
        total += min(1000.0 * across, CUT)
    return total / max(len(ids), 1)
