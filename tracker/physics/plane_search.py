"""The largest plane in a cloud: the table, the floor or the wall behind the hands."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from tracker.capture.static_plane import StaticPlane

Array = npt.NDArray[np.float64]

THICKNESS = 0.006
"""A point belongs to a plane that is so near, m; a depth camera's noise at a table's distance."""

TRIALS = 300
"""Of three points each: a plane of a third of the cloud is missed in one of 80,000 searches."""

MIN_POINTS = 100
"""Fewer show no plane."""


def find_plane(points: Array, eye: Array, min_points: int = MIN_POINTS) -> StaticPlane | None:
    """The plane with most points, its normal towards the eye; None where none has `min_points`. RANSAC, then refined.

    The same points give the same plane: the random numbers are always the same.

    Args:
        points: (N, 3) world, m.
        eye: (3,) from where they were seen, world, m.
        min_points: That must lie on it.
    """
    assert points.ndim == 2 and points.shape[1] == 3 and eye.shape == (3,)
    if len(points) < max(min_points, 3):
        return None
    corners = points[np.random.default_rng(0).integers(len(points), size=(TRIALS, 3))]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    is_plane = lengths > 1e-8
    normals, firsts = normals[is_plane] / lengths[is_plane, None], corners[is_plane, 0]
    if not len(normals):
        return None
    heights = points @ normals.T - np.sum(firsts * normals, axis=1)
    best = int(np.argmax(np.count_nonzero(np.abs(heights) < THICKNESS, axis=0)))
    on_plane = points[np.abs(heights[:, best]) < THICKNESS]
    middle, normal = on_plane.mean(axis=0), normals[best]
    for _ in range(3):
        middle = on_plane.mean(axis=0)
        normal = np.linalg.svd(on_plane - middle, full_matrices=False)[2][2]
        on_plane = points[np.abs((points - middle) @ normal) < THICKNESS]
        if len(on_plane) < max(min_points, 3):
            return None
    normal = normal if (eye - middle) @ normal > 0.0 else -normal
    (x, y, z), (nx, ny, nz) = middle.tolist(), (normal / np.linalg.norm(normal)).tolist()
    return StaticPlane((x, y, z), (nx, ny, nz))
