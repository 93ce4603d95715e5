"""Exact derivatives of a blend model's vertices and joints, as kernels; symbols as in `blend_kernels`.

A turn δ of bone k multiplies from the left, R_k <- exp(δ) R_k. What hangs on k turns about g_k by G_parent(k) δ, and
the pose blend shapes of k change with the elements of [δ]x R_k.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from tracker.model.blend_kernels import FAST, Array, BlendArrays, PosedArrays


@njit(cache=True, nogil=True)
def shape_motions(posed: PosedArrays, arrays: BlendArrays) -> tuple[Array, Array]:
    """How shape moves the bones, the rotations held.

    Returns:
        joint_shape: (B, 3, S) derivative of the posed joints, m.
        offset_shape: (B, 3, S) derivative of the translations of `Ts`, m.
    """
    B, S = len(arrays.parents), arrays.shape_directions.shape[2]
    at_rest, moved, offsets = np.zeros((B, 3, S)), np.zeros((B, 3, S)), np.zeros((B, 3, S))
    for b in range(B):
        for n in range(arrays.regressor_starts[b], arrays.regressor_starts[b + 1]):
            direction, share = arrays.shape_directions[arrays.regressor_vertices[n]], arrays.regressor_values[n]
            for x in range(3):
                for s in range(S):
                    at_rest[b, x, s] += share * direction[x, s]
        parent = arrays.parents[b]
        for s in range(S):
            for r in range(3):
                if parent < 0:
                    moved[b, r, s] = at_rest[b, r, s]
                else:
                    moved[b, r, s] = moved[parent, r, s]
                    for c in range(3):
                        step = at_rest[b, c, s] - at_rest[parent, c, s]
                        moved[b, r, s] += posed.Ts[parent, r, c] * step
            for r in range(3):
                offsets[b, r, s] = moved[b, r, s]
                for c in range(3):
                    offsets[b, r, s] -= posed.Ts[b, r, c] * at_rest[b, c, s]
    return moved, offsets


@njit(cache=True, nogil=True, fastmath=FAST)
def vertex_rows_into(jacobian, first, last, ids, posed, arrays, offset_shape, with_blend, num_shape):
    """Write the derivative of the posed vertices ids[first:last] to jacobian[: last - first].

    Args:
        jacobian: (N, 3, P) out, P = 6 + 3 (B - 1) + num_shape: the root's turn, the translation, the turn of every
            other bone, the shape.
        first: Of the vertices.
        last: Of the vertices, left out.
        ids: (M,) vertices.
        posed: The pose.
        arrays: The model.
        offset_shape: From `shape_motions`.
        with_blend: With the derivative of the pose blend shapes.
        num_shape: S, or 0 to leave the shape out.
    """
    B = len(arrays.parents)
    sums, shares, C, touched = np.zeros((B, 3)), np.zeros(B), np.zeros((3, 3)), np.zeros(B, dtype=np.int64)
    start = 6 + 3 * (B - 1)
    Ts, Rs, blocks, directions, joints = posed.Ts, posed.Rs, arrays.blocks, arrays.shape_directions, posed.joints
    for n in range(last - first):
        v = ids[first + n]
        for r in range(3):
            for p in range(start + num_shape):
                jacobian[n, r, p] = 0.0
            for c in range(3):
                C[r, c] = 0.0
            jacobian[n, r, 3 + r] = 1.0
        x, y, z = posed.rest[v, 0], posed.rest[v, 1], posed.rest[v, 2]
        num_touched = 0
        for slot in range(arrays.weights.shape[1]):
            weight = arrays.weights[v, slot]
            if weight == 0.0:
                break
            bone = arrays.weight_bones[v, slot]
            bx = weight * (Ts[bone, 0, 0] * x + Ts[bone, 0, 1] * y + Ts[bone, 0, 2] * z + Ts[bone, 0, 3])
            by = weight * (Ts[bone, 1, 0] * x + Ts[bone, 1, 1] * y + Ts[bone, 1, 2] * z + Ts[bone, 1, 3])
            bz = weight * (Ts[bone, 2, 0] * x + Ts[bone, 2, 1] * y + Ts[bone, 2, 2] * z + Ts[bone, 2, 3])
            for r in range(3):
                for c in range(3):
                    C[r, c] += weight * Ts[bone, r, c]
                for s in range(num_shape):
                    jacobian[n, r, start + s] += weight * offset_shape[bone, r, s]
            while bone >= 0:
                if shares[bone] == 0.0:
                    touched[num_touched] = bone
                    num_touched += 1
                sums[bone, 0] += bx
                sums[bone, 1] += by
                sums[bone, 2] += bz
                shares[bone] += weight
                bone = arrays.parents[bone]
        for place in range(num_touched):
            bone = touched[place]
            ox = sums[bone, 0] - shares[bone] * joints[bone, 0]
            oy = sums[bone, 1] - shares[bone] * joints[bone, 1]
            oz = sums[bone, 2] - shares[bone] * joints[bone, 2]
            shares[bone] = sums[bone, 0] = sums[bone, 1] = sums[bone, 2] = 0.0
            parent = arrays.parents[bone]
            if parent < 0:
                jacobian[n, 1, 0], jacobian[n, 2, 0] = -oz, oy
                jacobian[n, 0, 1], jacobian[n, 2, 1] = oz, -ox
                jacobian[n, 0, 2], jacobian[n, 1, 2] = -oy, ox
            else:
                for axis in range(3):
                    ax, ay, az = Ts[parent, 0, axis], Ts[parent, 1, axis], Ts[parent, 2, axis]
                    column = 3 + 3 * bone + axis
                    jacobian[n, 0, column] = ay * oz - az * oy
                    jacobian[n, 1, column] = az * ox - ax * oz
                    jacobian[n, 2, column] = ax * oy - ay * ox
        if with_blend:
            for m in range(arrays.block_starts[v], arrays.block_starts[v + 1]):
                bone = arrays.block_bones[m]
                column = 3 + 3 * bone
                r00, r01, r02 = Rs[bone, 0, 0], Rs[bone, 0, 1], Rs[bone, 0, 2]
                r10, r11, r12 = Rs[bone, 1, 0], Rs[bone, 1, 1], Rs[bone, 1, 2]
                r20, r21, r22 = Rs[bone, 2, 0], Rs[bone, 2, 1], Rs[bone, 2, 2]
                for p in range(3):
                    d0, d1, d2 = blocks[m, p, 0], blocks[m, p, 1], blocks[m, p, 2]
                    d3, d4, d5 = blocks[m, p, 3], blocks[m, p, 4], blocks[m, p, 5]
                    d6, d7, d8 = blocks[m, p, 6], blocks[m, p, 7], blocks[m, p, 8]
                    # a turn about axis i changes row j of R by row k and row k by -row j, (i, j, k) cyclic
                    e0 = d6 * r10 + d7 * r11 + d8 * r12 - d3 * r20 - d4 * r21 - d5 * r22
                    e1 = d0 * r20 + d1 * r21 + d2 * r22 - d6 * r00 - d7 * r01 - d8 * r02
                    e2 = d3 * r00 + d4 * r01 + d5 * r02 - d0 * r10 - d1 * r11 - d2 * r12
                    for r in range(3):
                        jacobian[n, r, column] += C[r, p] * e0
                        jacobian[n, r, column + 1] += C[r, p] * e1
                        jacobian[n, r, column + 2] += C[r, p] * e2
        for r in range(3):
            for p in range(3):
                for s in range(num_shape):
                    jacobian[n, r, start + s] += C[r, p] * directions[v, p, s]


@njit(cache=True, nogil=True)
def vertex_jacobian_into(jacobian, posed, arrays, vertex_ids, with_blend, num_shape):
    """Write the derivative of the vertices `vertex_ids` (N,): jacobian (N, 3, P) as in `vertex_rows_into`."""
    _, offset_shape = shape_motions(posed, arrays)
    vertex_rows_into(jacobian, 0, len(vertex_ids), vertex_ids, posed, arrays, offset_shape, with_blend, num_shape)


@njit(cache=True, nogil=True)
def joint_jacobian_into(jacobian, posed, arrays, num_shape):
    """Write the derivative of the posed joints: jacobian (B, 3, P), columns as in `vertex_rows_into`."""
    B = len(arrays.parents)
    moved, _ = shape_motions(posed, arrays)
    jacobian[:, :, :] = 0.0
    first_shape = 6 + 3 * (B - 1)
    for b in range(B):
        for axis in range(3):
            jacobian[b, axis, 3 + axis] = 1.0
            for s in range(num_shape):
                jacobian[b, axis, first_shape + s] = moved[b, axis, s]
        above = arrays.parents[b]
        while above >= 0:
            ox = posed.joints[b, 0] - posed.joints[above, 0]
            oy = posed.joints[b, 1] - posed.joints[above, 1]
            oz = posed.joints[b, 2] - posed.joints[above, 2]
            parent = arrays.parents[above]
            for axis in range(3):
                if parent < 0:
                    ax, ay, az = 1.0 * (axis == 0), 1.0 * (axis == 1), 1.0 * (axis == 2)
                    column = axis
                else:
                    G = posed.Ts[parent]
                    ax, ay, az = G[0, axis], G[1, axis], G[2, axis]
                    column = 3 + 3 * above + axis
                jacobian[b, 0, column] = ay * oz - az * oy
                jacobian[b, 1, column] = az * ox - ax * oz
                jacobian[b, 2, column] = ax * oy - ay * ox
            above = parent
