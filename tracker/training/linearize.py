"""Normal equations of a posed model against target vertices, in one pass over the vertices.

Unknowns are right-handed turns of the local rotations, R_b <- R_b exp(δ_b), 3B; the translation, 3; and, if asked for,
the rest joints, 3B. The derivative is exact: blend shapes move with the pose, too.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from tracker.model.blend_kernels import move_bones_into
from tracker.training.motion import compute_features

BLOCK = 16
"""Vertices whose Jacobian is held at a time; 48 rows of 99 unknowns stay in the first-level cache."""


@njit(cache=True, nogil=True, fastmath={"reassoc", "contract", "nsz"})
def linearize(
    template, joints, parents, bones, weights, directions, target, rotations, translation, with_joints, H, g
):  # fmt: skip
    """H = JᵀJ and g = Jᵀr of r = posed - target, and the cost Σ|r|².

    Args:
        template: (V, 3); joints (B, 3); parents (B,); bones, weights (V, 4); directions (V, 3, 9(B-1)) or (V, 3, 0).
        target: (V, 3).
        rotations: (B, 3, 3) local; translation (3,).
        with_joints: Whether the rest joints are unknowns, too.
        H: (D, D), D = 3B + 3 or 6B + 3, is written; g (D,) too. With D = 0 only the cost is computed.

    Returns:
        The sum of squared residuals.
    """
    B, V, D = len(parents), len(template), len(g)
    T, q = np.empty((B, 3, 4)), np.empty((B, 3))
    move_bones_into(T, q, rotations, joints, parents, translation)
    num_features = directions.shape[2]
    features = compute_features(rotations)
    differences = np.empty((B, 3, 3))  # of a joint's parent's rotation and its own
    for b in range(B):
        for i in range(3):
            for j in range(3):
                above = T[parents[b], i, j] if parents[b] >= 0 else (1.0 if i == j else 0.0)
                differences[b, i, j] = above - T[b, i, j]
    J, r = np.zeros((D, 3 * BLOCK)), np.zeros(3 * BLOCK)
    mass, moment = np.empty(B), np.empty((B, 3))
    A, rest, local = np.empty((3, 3)), np.empty(3), np.empty((3, 3))
    H[:] = 0.0
    g[:] = 0.0
    cost = 0.0
    for first in range(0, V, BLOCK):
        rows = 3 * min(BLOCK, V - first)
        for v in range(first, min(V, first + BLOCK)):
            row = 3 * (v - first)
            for i in range(3):
                total = template[v, i]
                for n in range(num_features):
                    total += directions[v, i, n] * features[n]
                rest[i] = total
                r[row + i] = -target[v, i]
            mass[:] = 0.0
            moment[:] = 0.0
            A[:] = 0.0
            for place in range(bones.shape[1]):
                bone, w = bones[v, place], weights[v, place]
                if w == 0.0:
                    continue
                x0 = T[bone, 0, 0] * rest[0] + T[bone, 0, 1] * rest[1] + T[bone, 0, 2] * rest[2] + T[bone, 0, 3]
                x1 = T[bone, 1, 0] * rest[0] + T[bone, 1, 1] * rest[1] + T[bone, 1, 2] * rest[2] + T[bone, 1, 3]
                x2 = T[bone, 2, 0] * rest[0] + T[bone, 2, 1] * rest[1] + T[bone, 2, 2] * rest[2] + T[bone, 2, 3]
                r[row] += w * x0
                r[row + 1] += w * x1
                r[row + 2] += w * x2
                for i in range(3):
                    for j in range(3):
                        A[i, j] += w * T[bone, i, j]
                up = bone
                while up >= 0:
                    mass[up] += w
                    moment[up, 0] += w * x0
                    moment[up, 1] += w * x1
                    moment[up, 2] += w * x2
                    up = parents[up]
            for i in range(3):
                cost += r[row + i] * r[row + i]
            if D == 0:
                continue
            for b in range(B):
                if mass[b] != 0.0:
                    y0, y1 = moment[b, 0] - mass[b] * q[b, 0], moment[b, 1] - mass[b] * q[b, 1]
                    y2 = moment[b, 2] - mass[b] * q[b, 2]
                    for j in range(3):
                        e0, e1, e2 = T[b, 0, j], T[b, 1, j], T[b, 2, j]
                        J[3 * b + j, row] = e1 * y2 - e2 * y1
                        J[3 * b + j, row + 1] = e2 * y0 - e0 * y2
                        J[3 * b + j, row + 2] = e0 * y1 - e1 * y0
                else:
                    for j in range(3):
                        for i in range(3):
                            J[3 * b + j, row + i] = 0.0
                if num_features > 0 and b > 0:
                    n = 9 * (b - 1)
                    Q = rotations[b]
                    for i in range(3):
                        d = directions[v, i]
                        c01 = d[n] * Q[0, 1] + d[n + 3] * Q[1, 1] + d[n + 6] * Q[2, 1]
                        c02 = d[n] * Q[0, 2] + d[n + 3] * Q[1, 2] + d[n + 6] * Q[2, 2]
                        c10 = d[n + 1] * Q[0, 0] + d[n + 4] * Q[1, 0] + d[n + 7] * Q[2, 0]
                        c12 = d[n + 1] * Q[0, 2] + d[n + 4] * Q[1, 2] + d[n + 7] * Q[2, 2]
                        c20 = d[n + 2] * Q[0, 0] + d[n + 5] * Q[1, 0] + d[n + 8] * Q[2, 0]
                        c21 = d[n + 2] * Q[0, 1] + d[n + 5] * Q[1, 1] + d[n + 8] * Q[2, 1]
                        local[i, 0], local[i, 1], local[i, 2] = c12 - c21, c20 - c02, c01 - c10
                    for j in range(3):
                        for i in range(3):
                            J[3 * b + j, row + i] += (
                                A[i, 0] * local[0, j] + A[i, 1] * local[1, j] + A[i, 2] * local[2, j]
                            )
            for i in range(3):
                for j in range(3):
                    J[3 * B + j, row + i] = 1.0 if i == j else 0.0
            if with_joints:
                for b in range(B):
                    for j in range(3):
                        for i in range(3):
                            J[3 * B + 3 + 3 * b + j, row + i] = mass[b] * differences[b, i, j]
        for a in range(D):
            total = 0.0
            for n in range(rows):
                total += J[a, n] * r[n]
            g[a] += total
            for c in range(a + 1):
                total = 0.0
                for n in range(rows):
                    total += J[a, n] * J[c, n]
                H[a, c] += total
    for a in range(D):
        for c in range(a):
            H[c, a] = H[a, c]
    return cost
