"""Where the bones of a subject's hand are in a pose, and skin that follows them by dual quaternions."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from numba import njit

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]


@njit(cache=True, nogil=True)
def pose_bones(
    Ts: Array,
    turned: Array,
    angles: Array,
    dof_bones: Ints,
    is_abduction: npt.NDArray[np.bool_],
    axes: Array,
    joints: Array,
    parents: Ints,
    rolls: Array,
) -> None:
    """Write Ts (B, 3, 4), rest to posed, for angles (D,) rad about axes (D, 3) through joints (B, 3).

    Also writes turned (D, 3), the axes in the pose. A bone is spread first, then bent about its own axis, then twisted;
    its angles stand in the order flexion, abduction, twist. A phalanx rolls over the head of the one before: its centre
    of rotation moves by rolls (B, 3) times one minus the cosine of its flexion. Parents (B,) stand before children.
    """
    dof = 0
    for b in range(len(joints)):
        p = parents[b]
        Rp = np.eye(3) if p < 0 else np.ascontiguousarray(Ts[p, :, :3])
        first = dof
        while dof < len(angles) and dof_bones[dof] == b:
            dof += 1
        R = np.eye(3)
        bend = 0.0
        for d in range(first, dof):
            if is_abduction[d]:
                R = _rotation(axes[d], angles[d])
                turned[d] = Rp @ axes[d]
        for d in range(first, dof):
            if not is_abduction[d]:
                turned[d] = Rp @ (R @ axes[d])
                R = R @ _rotation(axes[d], angles[d])
                if d == first:
                    bend = 1.0 - np.cos(angles[d])
        t = joints[b] - R @ joints[b] + bend * rolls[b]
        Ts[b, :, :3] = Rp @ R
        Ts[b, :, 3] = Rp @ t
        if p >= 0:
            Ts[b, :, 3] += Ts[p, :, 3]


@njit(cache=True, nogil=True)
def _rotation(axis: Array, angle: float) -> Array:
    """(3, 3) about a unit axis (3,)."""
    c, s = np.cos(angle), np.sin(angle)
    x, y, z = axis[0], axis[1], axis[2]
    R = np.empty((3, 3))
    R[0, 0], R[0, 1], R[0, 2] = c + x * x * (1 - c), x * y * (1 - c) - z * s, x * z * (1 - c) + y * s
    R[1, 0], R[1, 1], R[1, 2] = y * x * (1 - c) + z * s, c + y * y * (1 - c), y * z * (1 - c) - x * s
    R[2, 0], R[2, 1], R[2, 2] = z * x * (1 - c) - y * s, z * y * (1 - c) + x * s, c + z * z * (1 - c)
    return R


def dual_quaternions(Ts: Array) -> Array:
    """(B, 8) real and dual part, wxyz each, of rigid motions (B, 3, 4); Kavan et al. 2007."""
    real = np.array([_quaternion(T[:, :3]) for T in Ts])
    w, v, t = real[:, :1], real[:, 1:], Ts[:, :, 3]
    dual = 0.5 * np.concatenate([-np.sum(t * v, axis=1, keepdims=True), w * t + np.cross(t, v)], axis=1)
    return np.concatenate([real, dual], axis=1)


def _quaternion(R: Array) -> Array:
    """(4,) wxyz of a rotation (3, 3), by the largest of its four components."""
    squares = np.array([np.trace(R), R[0, 0], R[1, 1], R[2, 2]])
    largest = int(np.argmax(squares))
    if largest == 0:
        q = np.array([1.0 + np.trace(R), R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]])
    else:
        i = largest - 1
        j, k = (i + 1) % 3, (i + 2) % 3
        q = np.zeros(4)
        q[0] = R[k, j] - R[j, k]
        q[1 + i] = 1.0 + R[i, i] - R[j, j] - R[k, k]
        q[1 + j], q[1 + k] = R[i, j] + R[j, i], R[i, k] + R[k, i]
    return q / np.linalg.norm(q)


@njit(cache=True, nogil=True)
def skin(posed: Array, rest: Array, motions: Array, bone_ids: Ints, weights: Array) -> None:
    """Write posed (V, 3): rest (V, 3) moved by the blend of dual quaternions (B, 8), weights (V, K) of bones (V, K)."""
    for v in range(len(rest)):
        q = np.zeros(8)
        first = motions[bone_ids[v, 0]]
        for k in range(bone_ids.shape[1]):
            w = weights[v, k]
            if w == 0.0:
                continue
            m = motions[bone_ids[v, k]]
            dot = first[0] * m[0] + first[1] * m[1] + first[2] * m[2] + first[3] * m[3]
            if dot < 0.0:
                w = -w
            for i in range(8):
                q[i] += w * m[i]
        q /= np.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
        w0, x0, y0, z0, we, xe, ye, ze = q[0], q[1], q[2], q[3], q[4], q[5], q[6], q[7]
        px, py, pz = rest[v, 0], rest[v, 1], rest[v, 2]
        # p + 2 r x (r x p + w p), then the translation 2 (w d - e r + r x d).
        cx, cy, cz = y0 * pz - z0 * py + w0 * px, z0 * px - x0 * pz + w0 * py, x0 * py - y0 * px + w0 * pz
        posed[v, 0] = px + 2.0 * (y0 * cz - z0 * cy) + 2.0 * (w0 * xe - we * x0 + y0 * ze - z0 * ye)
        posed[v, 1] = py + 2.0 * (z0 * cx - x0 * cz) + 2.0 * (w0 * ye - we * y0 + z0 * xe - x0 * ze)
        posed[v, 2] = pz + 2.0 * (x0 * cy - y0 * cx) + 2.0 * (w0 * ze - we * z0 + x0 * ye - y0 * xe)
