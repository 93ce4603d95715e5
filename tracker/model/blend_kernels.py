"""Forward model of [R17] Eq. 1-4 and its derivative, as kernels over flat arrays.

Bone b turns by R_b = exp(pose_b) against its parent, about its joint. With G_b the product of rotations from the root
to b, j_b the joint at rest and g_b the joint posed (g_0 = j_0 + translation), bone b carries a point x of the rest
surface to G_b (x - j_b) + g_b, and a vertex goes to the sum of that by its skinning weights (`skinning`).

Degrees of freedom stand in this order: the root's turn about the axes of the world, the translation, the turn of every
other bone about the axes of its parent. A turn δ multiplies from the left, R_b <- exp(δ) R_b.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from numba import njit

from tracker.geometry.se3 import rotation_into
from tracker.model.skinning import (
    FAST,
    Array,
    Ints,
    PoseBlendArrays,
    add_pose_blend,
    shift_bones,
    skin_into,
    vertex_rows_into,
)

CHUNK = 32
"""Vertices whose derivative is held at a time; it stays in the first caches."""


class BlendArrays(NamedTuple):
    """A blend model, flat for the kernels.

    template (V, 3) m; shape_directions (V, 3, S) m, and what they do to the joints, joint_directions (B, 3, S) m;
    weight_bones, weights, parents, dof_starts and dofs as in `skinning`; regressor_starts (B + 1,), regressor_vertices
    and regressor_values (N,) the rows of the joint regressor; blend the pose blend shapes of each vertex, those of a
    bone that are all zero left out.
    """

    template: Array
    shape_directions: Array
    joint_directions: Array
    weight_bones: Ints
    weights: Array
    parents: Ints
    dof_starts: Ints
    dofs: Ints
    regressor_starts: Ints
    regressor_vertices: Ints
    regressor_values: Array
    blend: PoseBlendArrays


class PosedArrays(NamedTuple):
    """What the kernels work out of a pose.

    shaped (V, 3) template and shape, m; rest (V, 3) with pose blend shapes, m; joints_rest and joints (B, 3) m; Rs
    (B, 3, 3) each bone's own rotation; Ts (B, 3, 4) rest to posed; vertices (V, 3) posed, m.
    """

    shaped: Array
    rest: Array
    joints_rest: Array
    joints: Array
    Rs: Array
    Ts: Array
    vertices: Array

    @classmethod
    def empty(cls, num_vertices: int, num_bones: int) -> PosedArrays:
        """Room for all of it."""
        per_vertex, per_bone = (num_vertices, 3), (num_bones, 3)
        return cls(
            *(np.empty(shape) for shape in (per_vertex, per_vertex, per_bone, per_bone)),
            *(np.empty(shape) for shape in ((*per_bone, 3), (*per_bone, 4), per_vertex)),
        )


@njit(cache=True, nogil=True, fastmath=FAST)
def shape_into(shaped: Array, arrays: BlendArrays, shape: Array) -> None:
    """Write the template with its shape blend shapes, [R17] Eq. 4."""
    S = arrays.shape_directions.shape[2]
    for v in range(len(arrays.template)):
        for x in range(3):
            value = arrays.template[v, x]
            for s in range(S):
                value += arrays.shape_directions[v, x, s] * shape[s]
            shaped[v, x] = value


@njit(cache=True, nogil=True)
def regress_into(joints: Array, arrays: BlendArrays, vertices: Array) -> None:
    """Write the joints (B, 3) of unposed vertices (V, 3)."""
    for b in range(len(joints)):
        x = y = z = 0.0
        for n in range(arrays.regressor_starts[b], arrays.regressor_starts[b + 1]):
            v, share = arrays.regressor_vertices[n], arrays.regressor_values[n]
            x += share * vertices[v, 0]
            y += share * vertices[v, 1]
            z += share * vertices[v, 2]
        joints[b, 0], joints[b, 1], joints[b, 2] = x, y, z


@njit(cache=True, nogil=True)
def move_balls_into(Ts: Array, joints: Array, Rs: Array, rest: Array, parents: Ints, translation: Array) -> None:
    """Write how each bone moves, from its own rotation.

    Args:
        Ts: (B, 3, 4) out, from rest to posed.
        joints: (B, 3) out, posed, m.
        Rs: (B, 3, 3) of each bone against its parent.
        rest: (B, 3) joints at rest, m.
        parents: (B,) -1 for the root.
        translation: (3,) m.
    """
    for b in range(len(parents)):
        parent, R = parents[b], Rs[b]
        if parent < 0:
            for r in range(3):
                joints[b, r] = rest[b, r] + translation[r]
                for c in range(3):
                    Ts[b, r, c] = R[r, c]
        else:
            P = Ts[parent]
            for r in range(3):
                joints[b, r] = P[r, 0] * rest[b, 0] + P[r, 1] * rest[b, 1] + P[r, 2] * rest[b, 2] + P[r, 3]
                for c in range(3):
                    Ts[b, r, c] = P[r, 0] * R[0, c] + P[r, 1] * R[1, c] + P[r, 2] * R[2, c]
        for r in range(3):
            turned = Ts[b, r, 0] * rest[b, 0] + Ts[b, r, 1] * rest[b, 1] + Ts[b, r, 2] * rest[b, 2]
            Ts[b, r, 3] = joints[b, r] - turned


@njit(cache=True, nogil=True)
def place_into(posed: PosedArrays, arrays: BlendArrays, translation: Array) -> None:
    """From `shaped`, `joints_rest` and `Rs` to all else; translation (3,) m."""
    move_balls_into(posed.Ts, posed.joints, posed.Rs, posed.joints_rest, arrays.parents, translation)
    posed.rest[:] = posed.shaped
    add_pose_blend(posed.rest, posed.Ts, arrays.parents, arrays.blend)
    skin_into(posed.vertices, np.empty((0, 1, 3)), posed.rest, arrays, posed.Ts)


@njit(cache=True, nogil=True)
def pose_into(posed: PosedArrays, arrays: BlendArrays, pose: Array, translation: Array) -> None:
    """From the shaped vertices to the posed ones.

    Args:
        posed: `shaped` is read, all else is written.
        arrays: The model.
        pose: (B, 3) rotation vector of each bone against its parent, rad.
        translation: (3,) m.
    """
    regress_into(posed.joints_rest, arrays, posed.shaped)
    for b in range(len(arrays.parents)):
        rotation_into(posed.Rs[b], pose[b])
    place_into(posed, arrays, translation)


@njit(cache=True, nogil=True)
def find_ball_twists(posed: PosedArrays, parents: Ints) -> Array:
    """(3 + 3B, 6) world twist (u, ω) of each degree of freedom."""
    twists = np.zeros((3 + 3 * len(parents), 6))
    for b in range(len(parents)):
        gx, gy, gz = posed.joints[b, 0], posed.joints[b, 1], posed.joints[b, 2]
        for axis in range(3):
            twist = twists[axis] if parents[b] < 0 else twists[3 + 3 * b + axis]
            for r in range(3):
                twist[3 + r] = posed.Ts[parents[b], r, axis] if parents[b] >= 0 else (1.0 if r == axis else 0.0)
            # u = g × ω, so that the joint stays
            twist[0] = gy * twist[5] - gz * twist[4]
            twist[1] = gz * twist[3] - gx * twist[5]
            twist[2] = gx * twist[4] - gy * twist[3]
            if parents[b] < 0:
                twists[3 + axis, axis] = 1.0
    return twists


@njit(cache=True, nogil=True, fastmath=FAST)
def add_blend_rows(jacobian: Array, ids: npt.NDArray[np.integer], posed: PosedArrays, arrays: BlendArrays) -> None:
    """Add what turns do to vertices (N,) through the pose blend shapes to their derivative (N, 3, 3 + 3B or more)."""
    Ts, Rs, blend = posed.Ts, posed.Rs, arrays.blend
    C = np.zeros((3, 3))
    for n in range(len(ids)):
        v = ids[n]
        C[:, :] = 0.0
        for slot in range(arrays.weights.shape[1]):
            weight = arrays.weights[v, slot]
            if weight == 0.0:
                break
            bone = arrays.weight_bones[v, slot]
            for r in range(3):
                for c in range(3):
                    C[r, c] += weight * Ts[bone, r, c]
        first, count = blend.starts[v], blend.starts[v + 1] - blend.starts[v]
        for m in range(count):
            bone = blend.bones[first + m]
            start, Q = 27 * first + 9 * m, Rs[bone]
            a0, a1, a2 = _turn_block(blend.blocks[start : start + 9], Q)
            b0, b1, b2 = _turn_block(blend.blocks[start + 9 * count : start + 9 * count + 9], Q)
            c0, c1, c2 = _turn_block(blend.blocks[start + 18 * count : start + 18 * count + 9], Q)
            for r in range(3):
                row, x, y, z = jacobian[n, r, 3 + 3 * bone : 6 + 3 * bone], C[r, 0], C[r, 1], C[r, 2]
                row[0] += x * a0 + y * b0 + z * c0
                row[1] += x * a1 + y * b1 + z * c1
                row[2] += x * a2 + y * b2 + z * c2


@njit(cache=True, nogil=True, fastmath=FAST)
def _turn_block(d, Q):
    """What turns about x, y, z do to Σ d_k R_k, R (3, 3) being Q: row j changes by row k and row k by -row j."""
    return (
        d[6] * Q[1, 0] + d[7] * Q[1, 1] + d[8] * Q[1, 2] - d[3] * Q[2, 0] - d[4] * Q[2, 1] - d[5] * Q[2, 2],
        d[0] * Q[2, 0] + d[1] * Q[2, 1] + d[2] * Q[2, 2] - d[6] * Q[0, 0] - d[7] * Q[0, 1] - d[8] * Q[0, 2],
        d[3] * Q[0, 0] + d[4] * Q[0, 1] + d[5] * Q[0, 2] - d[0] * Q[1, 0] - d[1] * Q[1, 1] - d[2] * Q[1, 2],
    )


@njit(cache=True, nogil=True)
def blend_jacobian_into(jacobian, ids, posed, arrays, with_blend, with_shape):
    """Write the derivative of vertices (N,): jacobian (N, 3, 3 + 3B + S), or 3 + 3B without the shape's columns.

    Args:
        jacobian: Out, m.
        ids: (N,) vertices.
        posed: The pose.
        arrays: The model.
        with_blend: With what turns do through the pose blend shapes.
        with_shape: With the columns of the shape.
    """
    joints, directions = np.empty((len(posed.Ts), 3, 0)), np.empty((len(posed.rest), 3, 0))
    if with_shape:
        joints, directions = arrays.joint_directions, arrays.shape_directions
    shifts, twists = shift_bones(posed.Ts, arrays.parents, joints), find_ball_twists(posed, arrays.parents)
    for first in range(0, len(ids), CHUNK):
        rows, own = jacobian[first : first + CHUNK], ids[first : first + CHUNK]
        vertex_rows_into(rows, own, posed.rest, posed.Ts, twists, arrays, shifts, directions)
        if with_blend:
            add_blend_rows(rows, own, posed, arrays)


@njit(cache=True, nogil=True)
def turn_into(result: Array, pose: Array, step: Array) -> None:
    """Write the rotation vectors (N, 3) of exp(step) exp(pose), of length at most pi."""
    for n in range(len(pose)):
        px, py, pz, pw = _quaternion(step[n, 0], step[n, 1], step[n, 2])
        qx, qy, qz, qw = _quaternion(pose[n, 0], pose[n, 1], pose[n, 2])
        w = pw * qw - px * qx - py * qy - pz * qz
        x = pw * qx + px * qw + py * qz - pz * qy
        y = pw * qy - px * qz + py * qw + pz * qx
        z = pw * qz + px * qy - py * qx + pz * qw
        if w < 0.0:
            w, x, y, z = -w, -x, -y, -z
        sine = np.sqrt(x * x + y * y + z * z)
        scale = 2.0 / w if sine < 1e-9 else 2.0 * np.arctan2(sine, w) / sine
        result[n, 0], result[n, 1], result[n, 2] = scale * x, scale * y, scale * z


@njit(cache=True, nogil=True)
def _quaternion(x, y, z):
    angle = np.sqrt(x * x + y * y + z * z)
    share = 0.5 - angle * angle / 48.0 if angle < 1e-6 else np.sin(0.5 * angle) / angle
    return share * x, share * y, share * z, np.cos(0.5 * angle)
