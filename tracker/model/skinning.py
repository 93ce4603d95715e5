"""Linear blend skinning and its exact derivative, [T16] Eq. 1 and [R17] Eq. 1-4: the kernels of every model.

A bone carries a point x at rest to Ts[bone] x, and a vertex goes to the sum of that by its weights. Every degree of
freedom d has at a pose a world twist (u_d, ω_d): a small change of it moves a point x of the bones below it by
ω_d × x + u_d. So a vertex moves by ω_d × s + m u_d, with m and s the sums, over its bones below d, of their weights and
of the weighted places that they carry it to.

`skin` below is a tuple of arrays of one of the models: weight_bones and weights (V, W) the bones that a vertex follows,
heaviest first, padded with weight 0; parents (B,) -1 for roots; dof_starts (B + 1,) and dofs (D,) each bone's own
degrees of freedom.
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

MAX_WEIGHTS = 4
"""Bones a vertex of a tracked or trained hand may follow, as game engines and glTF want it."""


class PoseBlendArrays(NamedTuple):
    """Pose blend shapes, flat for the kernels.

    vertices (N,) whose they are; starts (N + 1,) and bones (M,) the n bones of each; blocks (27 M,) for each vertex
    (3, n, 9) m, by the elements of R_bone - I, row by row.
    """

    vertices: Ints
    starts: Ints
    bones: Ints
    blocks: Array


@njit(cache=True, nogil=True, fastmath=FAST)
def add_pose_blend(rest: Array, Ts: Array, parents: Ints, blend: PoseBlendArrays) -> None:
    """Add what the pose does to the surface at rest (V, 3), m, [R17] Eq. 2-3."""
    features, own = np.empty((len(Ts), 9)), np.empty(9 * len(Ts))
    for bone in range(len(Ts)):
        parent = parents[bone]
        if parent >= 0:
            for r in range(3):
                for c in range(3):
                    turned = -1.0 if r == c else 0.0
                    for x in range(3):
                        turned += Ts[parent, x, r] * Ts[bone, x, c]
                    features[bone, 3 * r + c] = turned
    before, count = 0, 0
    for n in range(len(blend.vertices)):
        first, last, v = blend.starts[n], blend.starts[n + 1], blend.vertices[n]
        is_same = count == last - first  # neighbours mostly have the same bones
        for m in range(last - first):
            is_same = is_same and blend.bones[first + m] == blend.bones[before + m]
        if not is_same:
            for m in range(last - first):
                for k in range(9):
                    own[9 * m + k] = features[blend.bones[first + m], k]
        before, count = first, last - first
        for r in range(3):
            row = blend.blocks[27 * first + 9 * count * r : 27 * first + 9 * count * (r + 1)]
            total = 0.0
            for k in range(9 * count):
                total += row[k] * own[k]
            rest[v, r] += total


@njit(cache=True, nogil=True)
def skin_into(vertices: Array, bone_vertices: Array, rest: Array, skin, Ts: Array) -> None:
    """Write the posed vertices.

    Args:
        vertices: (V, 3) out, m.
        bone_vertices: (V, W, 3) out, where each of its bones alone would carry the vertex, m; (0, W, 3) for nobody.
        rest: (V, 3) m.
        skin: Who follows whom.
        Ts: (B, 3, 4) motion of each bone from rest.
    """
    is_wanted = len(bone_vertices) > 0
    for v in range(len(rest)):
        x, y, z = rest[v, 0], rest[v, 1], rest[v, 2]
        sx = sy = sz = 0.0
        for slot in range(skin.weights.shape[1]):
            weight = skin.weights[v, slot]
            if weight == 0.0:
                break
            T = Ts[skin.weight_bones[v, slot]]
            bx = T[0, 0] * x + T[0, 1] * y + T[0, 2] * z + T[0, 3]
            by = T[1, 0] * x + T[1, 1] * y + T[1, 2] * z + T[1, 3]
            bz = T[2, 0] * x + T[2, 1] * y + T[2, 2] * z + T[2, 3]
            if is_wanted:
                bone_vertices[v, slot, 0], bone_vertices[v, slot, 1], bone_vertices[v, slot, 2] = bx, by, bz
            sx += weight * bx
            sy += weight * by
            sz += weight * bz
        vertices[v, 0], vertices[v, 1], vertices[v, 2] = sx, sy, sz


@njit(cache=True, nogil=True)
def shift_bones(Ts: Array, parents: Ints, joints: Array) -> Array:
    """How the translations of the bones' motions change with the joints at rest, the turns held.

    A joint that moves by δ at rest moves all that follows it by (R_parent - R) δ.

    Args:
        Ts: (B, 3, 4) motion of each bone from rest.
        parents: (B,).
        joints: (B, 3, S) change of each joint at rest by S parameters, m; those of a root whose motion does not depend
            on where its joint is are zero.

    Returns:
        (B, 3, S) m.
    """
    shifts = np.zeros(joints.shape)
    for bone in range(len(parents)):
        parent = parents[bone]
        for r in range(3):
            for s in range(joints.shape[2]):
                shift = shifts[parent, r, s] if parent >= 0 else 0.0
                for c in range(3):
                    above = Ts[parent, r, c] if parent >= 0 else (1.0 if r == c else 0.0)
                    shift += (above - Ts[bone, r, c]) * joints[bone, c, s]
                shifts[bone, r, s] = shift
    return shifts


@njit(cache=True, nogil=True, fastmath=FAST)
def vertex_rows_into(jacobian, ids, rest, Ts, twists, skin, shifts, directions):
    """Write the derivative of posed vertices, their surface at rest held against the pose.

    Args:
        jacobian: (N, 3, D + S) out, m.
        ids: (N,) vertices.
        rest: (V, 3) m.
        Ts: (B, 3, 4) motion of each bone from rest.
        twists: (D, 6) world twist (u, ω) of each degree of freedom.
        skin: Who follows whom.
        shifts: (B, 3, S) from `shift_bones`.
        directions: (V, 3, S) change of the surface at rest by the same parameters, m; (V, 3, 0) if it does not.
    """
    parents, starts, dofs = skin.parents, skin.dof_starts, skin.dofs
    sums, shares, R = np.zeros((len(Ts), 3)), np.zeros(len(Ts)), np.zeros((3, 3))
    touched = np.zeros(len(Ts), dtype=np.int64)
    D, S, moved = len(twists), shifts.shape[2], directions.shape[2]
    for n in range(len(ids)):
        v = ids[n]
        for r in range(3):
            for p in range(D + S):
                jacobian[n, r, p] = 0.0
            for c in range(3):
                R[r, c] = 0.0
        x, y, z = rest[v, 0], rest[v, 1], rest[v, 2]
        num_touched = 0
        for slot in range(skin.weights.shape[1]):
            weight = skin.weights[v, slot]
            if weight == 0.0:
                break
            bone = skin.weight_bones[v, slot]
            bx = weight * (Ts[bone, 0, 0] * x + Ts[bone, 0, 1] * y + Ts[bone, 0, 2] * z + Ts[bone, 0, 3])
            by = weight * (Ts[bone, 1, 0] * x + Ts[bone, 1, 1] * y + Ts[bone, 1, 2] * z + Ts[bone, 1, 3])
            bz = weight * (Ts[bone, 2, 0] * x + Ts[bone, 2, 1] * y + Ts[bone, 2, 2] * z + Ts[bone, 2, 3])
            for r in range(3):
                for c in range(3):
                    R[r, c] += weight * Ts[bone, r, c]
                row, shift = jacobian[n, r, D:], shifts[bone, r]
                for s in range(S):
                    row[s] += weight * shift[s]
            while bone >= 0:
                if shares[bone] == 0.0:
                    touched[num_touched] = bone
                    num_touched += 1
                sums[bone, 0] += bx
                sums[bone, 1] += by
                sums[bone, 2] += bz
                shares[bone] += weight
                bone = parents[bone]
        for place in range(num_touched):
            bone = touched[place]
            sx, sy, sz, share = sums[bone, 0], sums[bone, 1], sums[bone, 2], shares[bone]
            shares[bone] = sums[bone, 0] = sums[bone, 1] = sums[bone, 2] = 0.0
            for k in range(starts[bone], starts[bone + 1]):
                d = dofs[k]
                jacobian[n, 0, d] = twists[d, 4] * sz - twists[d, 5] * sy + share * twists[d, 0]
                jacobian[n, 1, d] = twists[d, 5] * sx - twists[d, 3] * sz + share * twists[d, 1]
                jacobian[n, 2, d] = twists[d, 3] * sy - twists[d, 4] * sx + share * twists[d, 2]
        for r in range(3):
            row, a, b, c = jacobian[n, r, D:], R[r, 0], R[r, 1], R[r, 2]
            for s in range(moved):
                row[s] += a * directions[v, 0, s] + b * directions[v, 1, s] + c * directions[v, 2, s]


def keep_heaviest(skinning_weights: Array) -> Array:
    """Weights (V, B) with the MAX_WEIGHTS largest of each row, scaled to sum to one."""
    light = np.argsort(-skinning_weights, axis=1, kind="stable")[:, MAX_WEIGHTS:]
    weights = skinning_weights.copy()
    np.put_along_axis(weights, light, 0.0, axis=1)
    return weights / weights.sum(axis=1, keepdims=True)


def blend_motions(skinning_weights: Array, Ts: Array) -> Array:
    """(V, 3, 4) motion of each vertex from rest, of weights (V, B) and the bones' motions (B, 3, 4)."""
    return (skinning_weights @ Ts.reshape(len(Ts), 12)).reshape(-1, 3, 4)


def take_back(motions: Array, vertices: Array) -> Array:
    """(V, 3) where posed vertices (V, 3) were at rest, of their motions (V, 3, 4), m."""
    back = np.linalg.solve(motions[:, :, :3], (vertices - motions[:, :, 3])[:, :, None])
    return np.asarray(back[:, :, 0], dtype=np.float64)
