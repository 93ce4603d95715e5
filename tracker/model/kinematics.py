"""Forward kinematics of a scene of revolute joints, [T16] Eq. 1-4, as kernels over flat arrays."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from tracker.geometry.se3 import exp_into
from tracker.model.skinning import Array, Ints


class SceneArrays(NamedTuple):
    """The models of a scene, stacked flat for the kernels.

    vertices (V, 3) rest, each in its model's frame, m; faces (F, 3); weight_bones, weights, parents, dof_starts and
    dofs as in `skinning`, a bone's own degrees of freedom being its revolute joints and, of a root, the six before;
    root_joints (B, 3) joints at rest, m, used for roots, which turn about theirs; axes (D, 3) and points (D, 3) of the
    revolute joints at rest, by their places among `dofs`; chains (B, L) degrees of freedom that move a bone, padded
    with -1.
    """

    vertices: Array
    faces: Ints
    weight_bones: Ints
    weights: Array
    parents: Ints
    root_joints: Array
    dof_starts: Ints
    dofs: Ints
    axes: Array
    points: Array
    chains: Ints


@njit(cache=True, nogil=True)
def move_bones_into(Ms: Array, twists: Array, scene: SceneArrays, pose: Array) -> None:
    """Write the motion of each bone and the world twist of each degree of freedom.

    Args:
        Ms: (B, 3, 4) out, T_j(θ) T_j(0)^-1, model rest frame to world, m.
        twists: (D, 6) out, (u, ω) of each degree of freedom in the world, m and rad.
        scene: The scene.
        pose: (D,) per model the root twist (v, ω) then the joint angles.
    """
    T = np.zeros((4, 4))
    for bone in range(len(scene.parents)):
        parent = scene.parents[bone]
        M = Ms[bone]
        first = scene.dof_starts[bone]
        if parent < 0:
            start = scene.dofs[first]
            first += 6
            exp_into(T, pose[start : start + 6])
            M[:, :] = T[:3, :]
            joint = scene.root_joints[bone]
            cx = M[0, 0] * joint[0] + M[0, 1] * joint[1] + M[0, 2] * joint[2] + M[0, 3]
            cy = M[1, 0] * joint[0] + M[1, 1] * joint[1] + M[1, 2] * joint[2] + M[1, 3]
            cz = M[2, 0] * joint[0] + M[2, 1] * joint[1] + M[2, 2] * joint[2] + M[2, 3]
            twists[start : start + 6, :] = 0.0
            for axis in range(3):
                twists[start + axis, axis] = 1.0
                twists[start + 3 + axis, 3 + axis] = 1.0
            # u = -ω × c for ω the unit axes
            twists[start + 3, 1], twists[start + 3, 2] = cz, -cy
            twists[start + 4, 0], twists[start + 4, 2] = -cz, cx
            twists[start + 5, 0], twists[start + 5, 1] = cy, -cx
        else:
            M[:, :] = Ms[parent]
        for k in range(first, scene.dof_starts[bone + 1]):
            _turn(M, twists[scene.dofs[k]], scene.axes[k], scene.points[k], pose[scene.dofs[k]])


@njit(cache=True, nogil=True)
def _turn(M, twist, axis, point, angle):
    """M <- M exp(angle ξ) for the revolute joint ξ; its world twist goes to `twist`."""
    px = M[0, 0] * point[0] + M[0, 1] * point[1] + M[0, 2] * point[2] + M[0, 3]
    py = M[1, 0] * point[0] + M[1, 1] * point[1] + M[1, 2] * point[2] + M[1, 3]
    pz = M[2, 0] * point[0] + M[2, 1] * point[1] + M[2, 2] * point[2] + M[2, 3]
    wx = M[0, 0] * axis[0] + M[0, 1] * axis[1] + M[0, 2] * axis[2]
    wy = M[1, 0] * axis[0] + M[1, 1] * axis[1] + M[1, 2] * axis[2]
    wz = M[2, 0] * axis[0] + M[2, 1] * axis[1] + M[2, 2] * axis[2]
    twist[0], twist[1], twist[2] = wz * py - wy * pz, wx * pz - wz * px, wy * px - wx * py
    twist[3], twist[4], twist[5] = wx, wy, wz
    c, s = np.cos(angle), np.sin(angle)
    x, y, z = axis[0], axis[1], axis[2]
    t = 1.0 - c
    r00, r01, r02 = c + t * x * x, t * x * y - s * z, t * x * z + s * y
    r10, r11, r12 = t * x * y + s * z, c + t * y * y, t * y * z - s * x
    r20, r21, r22 = t * x * z - s * y, t * y * z + s * x, c + t * z * z
    for row in range(3):
        a, b, d = M[row, 0], M[row, 1], M[row, 2]
        M[row, 0] = a * r00 + b * r10 + d * r20
        M[row, 1] = a * r01 + b * r11 + d * r21
        M[row, 2] = a * r02 + b * r12 + d * r22
    M[0, 3] = px - (M[0, 0] * point[0] + M[0, 1] * point[1] + M[0, 2] * point[2])
    M[1, 3] = py - (M[1, 0] * point[0] + M[1, 1] * point[1] + M[1, 2] * point[2])
    M[2, 3] = pz - (M[2, 0] * point[0] + M[2, 1] * point[1] + M[2, 2] * point[2])
