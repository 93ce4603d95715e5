"""More cameras around what a first camera looks at."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.geometry import se3

Array = npt.NDArray[np.float64]

DIRECTIONS_DEG = ((45, 0), (-45, 0), (20, 25), (85, 10), (-85, 10), (-20, -25), (130, 15))
"""Azimuth and elevation, as seen from the first camera, of the others: no two of them, nor any and the first, face each
other, so every pair can triangulate."""


def surround(camera: Camera, center: Array, count: int) -> tuple[Camera, ...]:
    """`count` further cameras like the first, turned about `center` (3,), world, m: cam1, cam2, ..."""
    assert 0 <= count <= len(DIRECTIONS_DEG)
    T_world_center = np.eye(4)
    T_world_center[:3, :3] = camera.T_world_camera[:3, :3]
    T_world_center[:3, 3] = center
    T_center_camera = se3.inverse(T_world_center) @ camera.T_world_camera
    ring = []
    for number, (azimuth, elevation) in enumerate(DIRECTIONS_DEG[:count], start=1):
        turn = se3.exp(np.radians([0, 0, 0, 0, -azimuth, 0])) @ se3.exp(np.radians([0, 0, 0, -elevation, 0, 0]))
        ring.append(replace(camera, id=f"cam{number}", T_world_camera=T_world_center @ turn @ T_center_camera))
    return tuple(ring)
