"""Kernels of [R17] Eq. 1 for training: linear blend skinning with at most four bones per vertex.

Bones are numbered so that a parent comes before its children; bone 0 is the root. A pose is held as local rotation
matrices (B, 3, 3), turning a bone against its parent about its joint, and a translation (3,); bones move as those of
any blend model do (`blend_kernels.move_bones_into`).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from numba import njit

from tracker.model.blend_kernels import features_into, rotation_into

Array = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]

MOST_BONES = 4
"""Most bones that a vertex follows, as game engines and glTF need it."""


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
def compute_features(rotations):
    """(9(B-1),) vec(R_b - I) of the bones but the root, row by row, of rotations (B, 3, 3), [R17] Eq. 4."""
    features = np.empty((len(rotations), 9))
    features_into(features, rotations)
    return features[1:].copy().reshape(-1)


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
def blend(bones, weights, Ts, A, b):
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
                    b[v, i] += weight * Ts[bone, i, 3]
                    for j in range(3):
                        A[v, i, j] += weight * Ts[bone, i, j]


@njit(cache=True, nogil=True)
def turn(R, x, y, z):
    """R <- R exp([x, y, z]), in place."""
    E = np.empty((3, 3))
    rotation_into(E, np.array([x, y, z]))
    for i in range(3):
        r0, r1, r2 = R[i, 0], R[i, 1], R[i, 2]
        R[i, 0] = r0 * E[0, 0] + r1 * E[1, 0] + r2 * E[2, 0]
        R[i, 1] = r0 * E[0, 1] + r1 * E[1, 1] + r2 * E[2, 1]
        R[i, 2] = r0 * E[0, 2] + r1 * E[1, 2] + r2 * E[2, 2]
