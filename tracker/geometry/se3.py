"""Rigid motions: exponential map of twists and its inverse, [T16] Eq. 2-3.

A twist is (v, ω): translation first. T = exp(ξ^), 4x4.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from numba import njit

Array = npt.NDArray[np.float64]


@njit(cache=True, nogil=True)
def rotation_into(R: Array, rotation_vector: Array) -> None:
    """Write exp of a rotation vector (3,), rad, to the first three rows and columns of R."""
    x, y, z = rotation_vector[0], rotation_vector[1], rotation_vector[2]
    angle2 = x * x + y * y + z * z
    if angle2 < 1e-12:
        a, b = 1.0 - angle2 / 6.0, 0.5 - angle2 / 24.0
    else:
        angle = np.sqrt(angle2)
        a, b = np.sin(angle) / angle, (1.0 - np.cos(angle)) / angle2
    R[0, 0], R[0, 1], R[0, 2] = 1.0 - b * (y * y + z * z), b * x * y - a * z, b * x * z + a * y
    R[1, 0], R[1, 1], R[1, 2] = b * x * y + a * z, 1.0 - b * (x * x + z * z), b * y * z - a * x
    R[2, 0], R[2, 1], R[2, 2] = b * x * z - a * y, b * y * z + a * x, 1.0 - b * (x * x + y * y)


@njit(cache=True, nogil=True)
def exp_into(T: Array, twist: Array) -> None:
    """Write exp of a (6,) twist to the (4, 4) array T."""
    rotation_into(T, twist[3:])
    wx, wy, wz = twist[3], twist[4], twist[5]
    theta2 = wx * wx + wy * wy + wz * wz
    if theta2 < 1e-12:
        b, c = 0.5 - theta2 / 24.0, 1.0 / 6.0 - theta2 / 120.0
    else:
        theta = np.sqrt(theta2)
        b, c = (1.0 - np.cos(theta)) / theta2, (theta - np.sin(theta)) / (theta2 * theta)
    vx, vy, vz = twist[0], twist[1], twist[2]
    T[0, 3] = (1 - c * (wy * wy + wz * wz)) * vx + (c * wx * wy - b * wz) * vy + (c * wx * wz + b * wy) * vz
    T[1, 3] = (c * wx * wy + b * wz) * vx + (1 - c * (wx * wx + wz * wz)) * vy + (c * wy * wz - b * wx) * vz
    T[2, 3] = (c * wx * wz - b * wy) * vx + (c * wy * wz + b * wx) * vy + (1 - c * (wx * wx + wy * wy)) * vz
    T[3, 0] = T[3, 1] = T[3, 2] = 0.0
    T[3, 3] = 1.0


def exp(twist: Array) -> Array:
    """Rigid motion (4, 4) of a (6,) twist (v, ω), [T16] Eq. 3."""
    twist = np.ascontiguousarray(twist, dtype=np.float64)
    assert twist.shape == (6,)
    T = np.zeros((4, 4))
    exp_into(T, twist)
    return T


def log(T: Array) -> Array:
    """The (6,) twist (v, ω), |ω| ≤ π, whose exponential is the rigid motion T (4, 4)."""
    assert T.shape == (4, 4)
    R, t = T[:3, :3], T[:3, 3]
    omega = _log_rotation(R)
    theta = float(np.linalg.norm(omega))
    W = _hat(omega)
    if theta < 1e-6:
        V_inverse = np.eye(3) - 0.5 * W + W @ W / 12.0
    else:
        half = 0.5 * theta
        V_inverse = np.eye(3) - 0.5 * W + (1.0 - half / np.tan(half)) / theta**2 * (W @ W)
    return np.concatenate([V_inverse @ t, omega])


def inverse(T: Array) -> Array:
    """Inverse of a rigid motion (4, 4)."""
    result = np.eye(4)
    result[:3, :3] = T[:3, :3].T
    result[:3, 3] = -T[:3, :3].T @ T[:3, 3]
    return result


def transform(T: Array, points: Array) -> Array:
    """Move points (..., 3) by the rigid motion T (4, 4)."""
    return points @ T[:3, :3].T + T[:3, 3]


def find_rotations(moments: Array) -> Array:
    """Rotations (..., 3, 3) that lay points on others best (Kabsch), of Σ other pointᵀ (..., 3, 3) about the means."""
    U, _, Vt = np.linalg.svd(moments)
    U[..., 2] *= np.linalg.det(U @ Vt)[..., None]
    return U @ Vt


def _hat(omega: Array) -> Array:
    x, y, z = omega
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def _log_rotation(R: Array) -> Array:
    """Rotation vector by way of the quaternion, stable from 0 to π."""
    m = R
    candidates = np.array(
        [
            m[0, 0] + m[1, 1] + m[2, 2],
            m[0, 0] - m[1, 1] - m[2, 2],
            m[1, 1] - m[0, 0] - m[2, 2],
            m[2, 2] - m[0, 0] - m[1, 1],
        ]
    )
    best = int(np.argmax(candidates))
    s = 2.0 * np.sqrt(1.0 + candidates[best])
    if best == 0:
        q = np.array([s / 4, (m[2, 1] - m[1, 2]) / s, (m[0, 2] - m[2, 0]) / s, (m[1, 0] - m[0, 1]) / s])
    elif best == 1:
        q = np.array([(m[2, 1] - m[1, 2]) / s, s / 4, (m[0, 1] + m[1, 0]) / s, (m[0, 2] + m[2, 0]) / s])
    elif best == 2:
        q = np.array([(m[0, 2] - m[2, 0]) / s, (m[0, 1] + m[1, 0]) / s, s / 4, (m[1, 2] + m[2, 1]) / s])
    else:
        q = np.array([(m[1, 0] - m[0, 1]) / s, (m[0, 2] + m[2, 0]) / s, (m[1, 2] + m[2, 1]) / s, s / 4])
    if q[0] < 0:
        q = -q
    norm = float(np.linalg.norm(q[1:]))
    if norm < 1e-9:
        return 2.0 * q[1:] / q[0]
    return 2.0 * np.arctan2(norm, q[0]) / norm * q[1:]
