"""OpenCV's camera on many points: what `cv2.projectPoints` does, without the derivatives that it always makes."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

DISTORTION_PARAMETERS = 12
"""k1, k2, p1, p2, k3, k4, k5, k6, s1, s2, s3, s4: all of OpenCV's but the two of a tilted sensor."""

NEAREST = 1e-3
"""Depth, m, that a point behind a camera is given, so that its residual is large and finite."""


def project_points(points: Array, K: Array, distortion: Array) -> Array:
    """Pixels (M, 2) of points (M, 3) camera, m, with K (3, 3) px and distortion (12,)."""
    assert points.shape[1] == 3 and distortion.shape == (DISTORTION_PARAMETERS,)
    depth = np.maximum(points[:, 2], NEAREST)
    x, y = points[:, 0] / depth, points[:, 1] / depth
    k1, k2, p1, p2, k3, k4, k5, k6, s1, s2, s3, s4 = distortion.tolist()
    r2 = x * x + y * y
    radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3))
    if k4 or k5 or k6:
        radial /= 1 + r2 * (k4 + r2 * (k5 + r2 * k6))
    xy = 2 * x * y
    u = x * radial + p1 * xy + p2 * (r2 + 2 * x * x)
    v = y * radial + p1 * (r2 + 2 * y * y) + p2 * xy
    if s1 or s2 or s3 or s4:
        u, v = u + r2 * (s1 + r2 * s2), v + r2 * (s3 + r2 * s4)
    return np.stack([K[0, 0] * u + K[0, 2], K[1, 1] * v + K[1, 2]], axis=1)


def turn_vectors(vectors: Array) -> Array:
    """Rotations (n, 3, 3) of rotation vectors (n, 3), rad: Rodrigues' formula."""
    angle = np.linalg.norm(vectors, axis=1)
    small = angle < 1e-8
    safe = np.where(small, 1.0, angle)
    first = np.where(small, 1.0, np.sin(safe) / safe)[:, None, None]
    second = np.where(small, 0.5, (1 - np.cos(safe)) / safe**2)[:, None, None]
    hat = np.zeros((len(vectors), 3, 3))
    x, y, z = vectors.T
    hat[:, 0, 1], hat[:, 0, 2], hat[:, 1, 0] = -z, y, z
    hat[:, 1, 2], hat[:, 2, 0], hat[:, 2, 1] = -x, -y, x
    return np.eye(3) + first * hat + second * (hat @ hat)
