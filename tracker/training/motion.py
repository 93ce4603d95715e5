"""Kernels of [R17] Eq. 1: motions of the bones, and linear blend skinning with at most four bones per vertex.

Bones are numbered so that a parent comes before its children; bone 0 is the root. A pose is held as local rotation
matrices (B, 3, 3), turning a bone against its parent about its joint, and a translation (3,).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from numba import njit

Array = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]

MOST_BONES = 4
"""A vertex follows at most so many bones, as game engines and glTF want it."""


class SparseSkinning(NamedTuple):
    """bones (V, 4) and weights (V, 4), which sum to 1 per vertex; unused places have weight 0."""

    bones: Integers
    weights: Array


def sparsen_skinning(skinning_weights: Array) -> SparseSkinning:
    """The four largest of each row of skinning weights (V, B), scaled to sum to 1."""
    bones = np.argsort(-skinning_weights, axis=1, kind="stable")[:, :MOST_BONES]
    weights = np.take_along_axis(skinning_weights, bones, axis=1)
    weights = weights / weights.sum(1, keepdims=True)
    return SparseSkinning(np.ascontiguousarray(bones, dtype=np.int64), np.ascontiguousarray(weights))


def fill_skinning(skinning: SparseSkinning, num_bones: int) -> Array:
    """The same as (V, B)."""
    weights = np.zeros((len(skinning.bones), num_bones))
    np.add.at(weights, (np.arange(len(weights))[:, None], skinning.bones), skinning.weights)
    return weights


@njit(cache=True, nogil=True)
def compute_motions(rotations, translation, joints, parents, R, p, posed):
    """Rest to posed: x -> R_b x + p_b, and where each joint is, q_b.

    Args:
        rotations: (B, 3, 3) local; translation (3,); joints (B, 3) rest; parents (B,), -1 for the root.
        R: (B, 3, 3), p: (B, 3), posed: (B, 3) are written.
    """
    for b in range(len(parents)):
        parent = parents[b]
        for i in range(3):
            if parent < 0:
                for j in range(3):
                    R[b, i, j] = rotations[b, i, j]
                posed[b, i] = joints[b, i] + translation[i]
            else:
                for j in range(3):
                    R[b, i, j] = (
                        R[parent, i, 0] * rotations[b, 0, j]
                        + R[parent, i, 1] * rotations[b, 1, j]
                        + R[parent, i, 2] * rotations[b, 2, j]
                    )
                posed[b, i] = (
                    p[parent, i]
                    + R[parent, i, 0] * joints[b, 0]
                    + R[parent, i, 1] * joints[b, 1]
                    + R[parent, i, 2] * joints[b, 2]
                )
        for i in range(3):
            p[b, i] = posed[b, i] - R[b, i, 0] * joints[b, 0] - R[b, i, 1] * joints[b, 1] - R[b, i, 2] * joints[b, 2]


@njit(cache=True, nogil=True)
def compute_features(rotations, features):
    """vec(R_k - I) of the bones but the root, row by row, [R17] Eq. 4: features (9(B-1),) are written."""
    for b in range(1, len(rotations)):
        for i in range(3):
            for j in range(3):
                features[9 * (b - 1) + 3 * i + j] = rotations[b, i, j] - (1.0 if i == j else 0.0)


@njit(cache=True, nogil=True)
def correct_rest(template, directions, features, rest):
    """T + B_P, [R17] Eq. 2: rest (V, 3) is written. Directions are (V, 3, 9(B-1)), or (V, 3, 0) for none."""
    for v in range(len(template)):
        for i in range(3):
            total = template[v, i]
            for n in range(directions.shape[2]):
                total += directions[v, i, n] * features[n]
            rest[v, i] = total


@njit(cache=True, nogil=True)
def blend(bones, weights, R, p, A, b):
    """The affine map of each vertex, x -> A_v x + b_v: A (V, 3, 3) and b (V, 3) are written."""
    for v in range(len(bones)):
        for i in range(3):
            b[v, i] = 0.0
            for j in range(3):
                A[v, i, j] = 0.0
        for place in range(bones.shape[1]):
            bone, weight = bones[v, place], weights[v, place]
            if weight != 0.0:
                for i in range(3):
                    b[v, i] += weight * p[bone, i]
                    for j in range(3):
                        A[v, i, j] += weight * R[bone, i, j]


@njit(cache=True, nogil=True)
def turn(R, x, y, z):
    """R <- R exp([x, y, z]), in place."""
    theta2 = x * x + y * y + z * z
    if theta2 < 1e-12:
        a, b = 1.0 - theta2 / 6.0, 0.5 - theta2 / 24.0
    else:
        theta = np.sqrt(theta2)
        a, b = np.sin(theta) / theta, (1.0 - np.cos(theta)) / theta2
    e00, e01, e02 = 1.0 - b * (y * y + z * z), b * x * y - a * z, b * x * z + a * y
    e10, e11, e12 = b * x * y + a * z, 1.0 - b * (x * x + z * z), b * y * z - a * x
    e20, e21, e22 = b * x * z - a * y, b * y * z + a * x, 1.0 - b * (x * x + y * y)
    for i in range(3):
        r0, r1, r2 = R[i, 0], R[i, 1], R[i, 2]
        R[i, 0] = r0 * e00 + r1 * e10 + r2 * e20
        R[i, 1] = r0 * e01 + r1 * e11 + r2 * e21
        R[i, 2] = r0 * e02 + r1 * e12 + r2 * e22
