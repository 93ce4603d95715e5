"""Forward model of [R17] Eq. 1-4, as kernels over flat arrays.

Bone b turns by R_b = exp(pose_b) against its parent, about its joint. With G_b the product of rotations from the root
to b, j_b the joint at rest and g_b the joint posed (g_0 = j_0 + translation), bone b carries a point x of the rest
surface to G_b (x - j_b) + g_b, and a vertex goes to the sum of that by its skinning weights.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from numba import njit

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int32]

FAST = {"reassoc", "contract"}
"""Sums may be reordered, so that they are vectorised; nothing is assumed of the numbers."""


class BlendArrays(NamedTuple):
    """A blend model, flat for the kernels.

    template (V, 3) m; shape_directions (V, 3, S) m; weight_bones and weights (V, W) the bones a vertex follows,
    heaviest first, padded with weight 0; regressor_starts (B + 1,), regressor_vertices and regressor_values (N,) the
    rows of the joint regressor; parents (B,); block_starts (V + 1,), block_bones (M,) and blocks (M, 3, 9) the pose
    blend shapes of each vertex by bone, those that are all zero left out.
    """

    template: Array
    shape_directions: Array
    weight_bones: Ints
    weights: Array
    regressor_starts: Ints
    regressor_vertices: Ints
    regressor_values: Array
    parents: Ints
    block_starts: Ints
    block_bones: Ints
    blocks: Array


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
def rotation_into(R: Array, rotation_vector: Array) -> None:
    """Write exp of a rotation vector (3,) to R (3, 3)."""
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
def move_bones_into(Ts: Array, joints: Array, Rs: Array, rest: Array, parents: Ints, translation: Array) -> None:
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
def features_into(features: Array, Rs: Array) -> None:
    """Write vec(R_b - I) of each bone (B, 9), row by row, [R17] Eq. 4."""
    for b in range(len(Rs)):
        for r in range(3):
            for c in range(3):
                features[b, 3 * r + c] = Rs[b, r, c] - (1.0 if r == c else 0.0)


@njit(cache=True, nogil=True, fastmath=FAST)
def blend_into(rest: Array, shaped: Array, arrays: BlendArrays, Rs: Array) -> None:
    """Write the shaped vertices with their pose blend shapes, [R17] Eq. 2-3."""
    blocks, features = arrays.blocks, np.empty((len(Rs), 9))
    features_into(features, Rs)
    for v in range(len(shaped)):
        x, y, z = shaped[v, 0], shaped[v, 1], shaped[v, 2]
        for m in range(arrays.block_starts[v], arrays.block_starts[v + 1]):
            bone = arrays.block_bones[m]
            for n in range(9):
                feature = features[bone, n]
                x += blocks[m, 0, n] * feature
                y += blocks[m, 1, n] * feature
                z += blocks[m, 2, n] * feature
        rest[v, 0], rest[v, 1], rest[v, 2] = x, y, z


@njit(cache=True, nogil=True)
def skin_into(vertices: Array, rest: Array, arrays: BlendArrays, Ts: Array) -> None:
    """Write the posed vertices by linear blend skinning."""
    for v in range(len(rest)):
        x, y, z = rest[v, 0], rest[v, 1], rest[v, 2]
        sx = sy = sz = 0.0
        for slot in range(arrays.weights.shape[1]):
            weight = arrays.weights[v, slot]
            if weight == 0.0:
                break
            T = Ts[arrays.weight_bones[v, slot]]
            sx += weight * (T[0, 0] * x + T[0, 1] * y + T[0, 2] * z + T[0, 3])
            sy += weight * (T[1, 0] * x + T[1, 1] * y + T[1, 2] * z + T[1, 3])
            sz += weight * (T[2, 0] * x + T[2, 1] * y + T[2, 2] * z + T[2, 3])
        vertices[v, 0], vertices[v, 1], vertices[v, 2] = sx, sy, sz


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
    move_bones_into(posed.Ts, posed.joints, posed.Rs, posed.joints_rest, arrays.parents, translation)
    blend_into(posed.rest, posed.shaped, arrays, posed.Rs)
    skin_into(posed.vertices, posed.rest, arrays, posed.Ts)


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
