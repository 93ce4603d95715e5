"""How far observed points are from a fitted surface."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from numba import njit

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.integer]


def compute_surface_distances(points: Array, vertices: Array, faces: Ints) -> Array:
    """Distance (N,), m, of points (N, 3) to the nearest point of any triangle of a mesh, exact.

    Args:
        points: (N, 3) world, m.
        vertices: (V, 3) world, m.
        faces: (F, 3), at least one.
    """
    assert points.ndim == 2 and points.shape[1] == 3
    assert vertices.ndim == 2 and vertices.shape[1] == 3
    assert len(faces) > 0
    corners = np.ascontiguousarray(vertices[faces], dtype=np.float64)
    centers = corners.mean(axis=1)
    radii = np.linalg.norm(corners - centers[:, None], axis=2).max(axis=1)
    distances = np.zeros(len(points))
    _distances_into(distances, np.ascontiguousarray(points, dtype=np.float64), corners, centers, radii)
    return distances


def warm_up_distances() -> None:
    """Compile the kernels of this file."""
    compute_surface_distances(np.zeros((1, 3)), np.eye(3), np.array([[0, 1, 2]]))


@njit(cache=True, nogil=True)
def _distances_into(distances: Array, points: Array, corners: Array, centers: Array, radii: Array) -> None:
    nearest = 0
    for i in range(len(points)):
        point = points[i]
        # Neighbouring points have neighbouring triangles: start from the last one found.
        best = _squared_distance(point, corners[nearest])
        reach = np.sqrt(best)
        for f in range(len(corners)):
            dx, dy, dz = point[0] - centers[f, 0], point[1] - centers[f, 1], point[2] - centers[f, 2]
            limit = reach + radii[f]
            if dx * dx + dy * dy + dz * dz >= limit * limit:
                continue
            squared = _squared_distance(point, corners[f])
            if squared < best:
                best, reach, nearest = squared, np.sqrt(squared), f
        distances[i] = np.sqrt(best)


@njit(cache=True, nogil=True)
def _squared_distance(point: Array, corners: Array) -> float:
    """Squared distance of a point (3,) to a triangle (3, 3), by the region of the plane that its foot falls in.

    C. Ericson, Real-Time Collision Detection (2005), section 5.1.5.
    """
    a, b, c = corners[0], corners[1], corners[2]
    abx, aby, abz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    acx, acy, acz = c[0] - a[0], c[1] - a[1], c[2] - a[2]
    apx, apy, apz = point[0] - a[0], point[1] - a[1], point[2] - a[2]
    d1 = abx * apx + aby * apy + abz * apz
    d2 = acx * apx + acy * apy + acz * apz
    bpx, bpy, bpz = point[0] - b[0], point[1] - b[1], point[2] - b[2]
    d3 = abx * bpx + aby * bpy + abz * bpz
    d4 = acx * bpx + acy * bpy + acz * bpz
    cpx, cpy, cpz = point[0] - c[0], point[1] - c[1], point[2] - c[2]
    d5 = abx * cpx + aby * cpy + abz * cpz
    d6 = acx * cpx + acy * cpy + acz * cpz
    va, vb, vc = d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2
    if d1 <= 0.0 and d2 <= 0.0:
        s, t = 0.0, 0.0
    elif d3 >= 0.0 and d4 <= d3:
        s, t = 1.0, 0.0
    elif vc <= 0.0 and d1 >= 0.0 and d3 <= 0.0:
        s, t = d1 / (d1 - d3), 0.0
    elif d6 >= 0.0 and d5 <= d6:
        s, t = 0.0, 1.0
    elif vb <= 0.0 and d2 >= 0.0 and d6 <= 0.0:
        s, t = 0.0, d2 / (d2 - d6)
    elif va <= 0.0 and d4 - d3 >= 0.0 and d5 - d6 >= 0.0:
        t = (d4 - d3) / ((d4 - d3) + (d5 - d6))
        s = 1.0 - t
    else:
        total = va + vb + vc
        s, t = vb / total, vc / total
    dx, dy, dz = apx - s * abx - t * acx, apy - s * aby - t * acy, apz - s * abz - t * acz
    return dx * dx + dy * dy + dz * dz
