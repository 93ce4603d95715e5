"""Forward kinematics and linear blend skinning of a scene, [T16] Eq. 1-4, as kernels over flat arrays.

Every degree of freedom d has, at the current pose, a world twist (u_d, ω_d): a small change moves a point x that
follows it by ω_d × x + u_d. The derivative of a skinned vertex is the sum of that over its bones below d, each with
its own weight and its own moved point; nothing is approximated.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from numba import njit

from tracker.geometry.se3 import exp_into

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int32]


class SceneArrays(NamedTuple):
    """The models of a scene, stacked flat for the kernels.

    vertices (V, 3) rest, each in its model's frame, m; faces (F, 3); weight_bones (V, W) and weights (V, W) the bones
    that a vertex follows, padded with weight 0, heaviest first; parents (B,) -1 for roots; root_joints (B, 3) joints
    at rest, m, used for roots, which turn about theirs; joint_starts (B + 1,) range of revolute joints of a bone;
    joint_dofs (K,) place of a joint in the pose; axes (K, 3) and points (K, 3) of the joints at rest; bone_roots (B,)
    place of the six root parameters in the pose of the bone's model; chains (B, L) degrees of freedom that move a bone,
    padded with -1.
    """

    vertices: Array
    faces: Ints
    weight_bones: Ints
    weights: Array
    parents: Ints
    root_joints: Array
    joint_starts: Ints
    joint_dofs: Ints
    axes: Array
    points: Array
    bone_roots: Ints
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
        if parent < 0:
            start = scene.bone_roots[bone]
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
        for k in range(scene.joint_starts[bone], scene.joint_starts[bone + 1]):
            _turn(M, twists[scene.joint_dofs[k]], scene.axes[k], scene.points[k], pose[scene.joint_dofs[k]])


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


@njit(cache=True, nogil=True)
def skin_into(vertices: Array, bone_vertices: Array, scene: SceneArrays, Ms: Array) -> None:
    """Write the posed vertices, [T16] Eq. 1.

    Args:
        vertices: (V, 3) out, world, m.
        bone_vertices: (V, W, 3) out, where each of its bones alone would carry the vertex, world, m.
        scene: The scene.
        Ms: (B, 3, 4) from `move_bones_into`.
    """
    for v in range(len(scene.vertices)):
        x, y, z = scene.vertices[v, 0], scene.vertices[v, 1], scene.vertices[v, 2]
        sx = sy = sz = 0.0
        for slot in range(scene.weights.shape[1]):
            weight = scene.weights[v, slot]
            if weight == 0.0:
                break
            M = Ms[scene.weight_bones[v, slot]]
            bx = M[0, 0] * x + M[0, 1] * y + M[0, 2] * z + M[0, 3]
            by = M[1, 0] * x + M[1, 1] * y + M[1, 2] * z + M[1, 3]
            bz = M[2, 0] * x + M[2, 1] * y + M[2, 2] * z + M[2, 3]
            bone_vertices[v, slot, 0], bone_vertices[v, slot, 1], bone_vertices[v, slot, 2] = bx, by, bz
            sx += weight * bx
            sy += weight * by
            sz += weight * bz
        vertices[v, 0], vertices[v, 1], vertices[v, 2] = sx, sy, sz


@njit(cache=True, nogil=True)
def normals_into(normals: Array, vertices: Array, faces: Ints) -> None:
    """Write unit vertex normals (V, 3), area-weighted, outward for counter-clockwise faces; 0 where no face is."""
    normals[:, :] = 0.0
    for f in range(len(faces)):
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        ux, uy, uz = vertices[b, 0] - vertices[a, 0], vertices[b, 1] - vertices[a, 1], vertices[b, 2] - vertices[a, 2]
        wx, wy, wz = vertices[c, 0] - vertices[a, 0], vertices[c, 1] - vertices[a, 1], vertices[c, 2] - vertices[a, 2]
        nx, ny, nz = uy * wz - uz * wy, uz * wx - ux * wz, ux * wy - uy * wx
        for vertex in (a, b, c):
            normals[vertex, 0] += nx
            normals[vertex, 1] += ny
            normals[vertex, 2] += nz
    for v in range(len(normals)):
        length = np.sqrt(normals[v, 0] ** 2 + normals[v, 1] ** 2 + normals[v, 2] ** 2)
        if length > 0.0:
            normals[v, 0] /= length
            normals[v, 1] /= length
            normals[v, 2] /= length


@njit(cache=True, nogil=True)
def _vertex_jacobian_into(jacobian, weight_bones, weights, chains, bone_vertices, twists, vertex_ids):
    for row in range(len(vertex_ids)):
        v = vertex_ids[row]
        for slot in range(weights.shape[1]):
            weight = weights[v, slot]
            if weight == 0.0:
                break
            x, y, z = bone_vertices[v, slot, 0], bone_vertices[v, slot, 1], bone_vertices[v, slot, 2]
            chain = chains[weight_bones[v, slot]]
            for place in range(len(chain)):
                dof = chain[place]
                if dof < 0:
                    break
                t = twists[dof]
                jacobian[row, 0, dof] += weight * (t[4] * z - t[5] * y + t[0])
                jacobian[row, 1, dof] += weight * (t[5] * x - t[3] * z + t[1])
                jacobian[row, 2, dof] += weight * (t[3] * y - t[4] * x + t[2])


def vertex_jacobian(scene: SceneArrays, bone_vertices: Array, twists: Array, vertex_ids: Ints) -> Array:
    """Derivative of posed vertices by the pose, exact: (N, 3, D), m per unit of each degree of freedom.

    Root parameters are increments multiplied from the left about the root's joint, as `Scene.retract` applies them.
    """
    jacobian = np.zeros((len(vertex_ids), 3, len(twists)))
    ids = np.ascontiguousarray(vertex_ids, dtype=np.int32)
    _vertex_jacobian_into(jacobian, scene.weight_bones, scene.weights, scene.chains, bone_vertices, twists, ids)
    return jacobian
