"""Normal equations of a posed hand against target vertices, in one pass over the vertices.

Unknowns are those of any blend model (`blend_kernels`): the root's turn, the translation, the turns of the other bones,
3B + 3 together; and, if asked for, the rest joints, 3B. The derivative is exact: blend shapes move with the pose, too.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from tracker.model.blend_kernels import add_blend_rows, find_ball_twists
from tracker.model.skinning import shift_bones, vertex_rows_into

BLOCK = 32
"""Vertices whose Jacobian is held at a time: 96 rows of 51 or 99 unknowns stay in the second-level cache."""


@njit(cache=True, nogil=True, fastmath={"reassoc", "contract", "nsz"})
def linearize(H, g, posed, arrays, target):
    """Write H = JᵀJ and g = Jᵀr of r = posed - target.

    Args:
        H: (D, D) out, D = 3B + 3, or 6B + 3 with the rest joints among the unknowns.
        g: (D,) out.
        posed: The hand as it is posed, a `PosedArrays`.
        arrays: Of its model, a `BlendArrays`.
        target: (V, 3) m.
    """
    B, V, D = len(arrays.parents), len(target), len(g)
    joints = np.zeros((B, 3, D - 3 * B - 3))
    for b in range(B):
        for axis in range(3):
            if joints.shape[2] > 0:
                joints[b, axis, 3 * b + axis] = 1.0
    shifts, twists = shift_bones(posed.Ts, arrays.parents, joints), find_ball_twists(posed, arrays.parents)
    still = np.empty((V, 3, 0))
    rows, J, r = np.empty((BLOCK, 3, D)), np.empty((D, 3 * BLOCK)), np.empty(3 * BLOCK)
    H[:] = 0.0
    g[:] = 0.0
    for first in range(0, V, BLOCK):
        ids = np.arange(first, min(V, first + BLOCK))
        vertex_rows_into(rows, ids, posed.rest, posed.Ts, twists, arrays, shifts, still)
        add_blend_rows(rows, ids, posed, arrays)
        if len(ids) < BLOCK:
            J[:], r[:] = 0.0, 0.0
        for n in range(len(ids)):
            for i in range(3):
                r[3 * n + i] = posed.vertices[first + n, i] - target[first + n, i]
                for a in range(D):
                    J[a, 3 * n + i] = rows[n, i, a]
        for a in range(D):
            total = 0.0
            for n in range(3 * BLOCK):
                total += J[a, n] * r[n]
            g[a] += total
        for a in range(0, D, 3):
            for c in range(0, a + 1, 3):
                _add_products(H, a, c, J[a : a + 3], J[c : c + 3])
    for a in range(D):
        for c in range(a):
            H[c, a] = H[a, c]


@njit(cache=True, nogil=True, fastmath={"reassoc", "contract", "nsz"})
def _add_products(H, a, c, A, B):
    """H[a : a + 3, c : c + 3] += A Bᵀ for A and B (3, N): nine sums at a time, so that numbers are read less often."""
    a0, a1, a2, b0, b1, b2 = A[0], A[1], A[2], B[0], B[1], B[2]
    h00 = h01 = h02 = h10 = h11 = h12 = h20 = h21 = h22 = 0.0
    for n in range(len(a0)):
        h00 += a0[n] * b0[n]
        h01 += a0[n] * b1[n]
        h02 += a0[n] * b2[n]
        h10 += a1[n] * b0[n]
        h11 += a1[n] * b1[n]
        h12 += a1[n] * b2[n]
        h20 += a2[n] * b0[n]
        h21 += a2[n] * b1[n]
        h22 += a2[n] * b2[n]
    for i, row in enumerate(((h00, h01, h02), (h10, h11, h12), (h20, h21, h22))):
        for j, total in enumerate(row):
            H[a + i, c + j] += total
