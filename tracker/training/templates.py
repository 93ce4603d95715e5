"""Personalised templates: each person's own rest shape, [R17] section 3.3."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from numba import njit

from tracker.model.blend_kernels import move_bones_into
from tracker.training.motion import blend, compute_features, correct_rest
from tracker.training.pose_fit import Poses, Rig

Array = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]


def weigh_by_pose(poses: Poses, owners: Integers) -> Array:
    """(N,) weights of registrations for the first templates, [R17] Eq. 11: little where the hand is not at rest.

    Scaled to sum to 1 for each person. A pose nearer to rest than 0.5 rad at one joint counts no more than that, so
    that a single registration of a flat hand does not decide alone.
    """
    away = ((poses.rotations[:, 1:] - np.eye(3)) ** 2).sum((1, 2, 3))
    weights = 1.0 / np.maximum(away, 0.5) ** 2
    for person in np.unique(owners):
        weights[owners == person] /= weights[owners == person].sum()
    return weights


def fit_templates(poses: Poses, targets: Array, owners: Integers, weights: Array, joints: Array, rig: Rig) -> Array:
    """(S, V, 3) rest shapes that fit all registrations of each person in the least squares sense, m.

    Args:
        poses: Of the N registrations.
        targets: (N, V, 3) m; owners (N,) whose; weights (N,); joints (S, B, 3) m.
        rig: Its blend shapes are taken off.
    """
    V = targets.shape[1]
    squares, sides = np.zeros((len(joints), V, 3, 3)), np.zeros((len(joints), V, 3))
    for n, person in enumerate(owners):
        _add(
            joints[person],
            rig.parents,
            *rig.skinning,
            rig.directions,
            targets[n],
            poses.rotations[n],
            poses.translations[n],
            weights[n],
            squares[person],
            sides[person],
        )
    return np.asarray(np.linalg.solve(squares, sides[..., None])[..., 0], dtype=np.float64)


def unpose(poses: Poses, targets: Array, owners: Integers, joints: Array, rig: Rig) -> Array:
    """(N, V, 3) the targets in the rest pose, m: what template and blend shapes together should be."""
    rest = np.empty_like(targets)
    for n, person in enumerate(owners):
        _unpose(
            joints[person], rig.parents, *rig.skinning, targets[n], poses.rotations[n], poses.translations[n], rest[n]
        )
    return rest


@njit(cache=True, nogil=True)
def _add(joints, parents, bones, weights, directions, target, rotations, translation, weight, squares, sides):
    B, V = len(parents), len(target)
    Ts, posed = np.empty((B, 3, 4)), np.empty((B, 3))
    move_bones_into(Ts, posed, rotations, joints, parents, translation)
    features = compute_features(rotations)
    A, b, correction = np.empty((V, 3, 3)), np.empty((V, 3)), np.empty((V, 3))
    blend(bones, weights, Ts, A, b)
    correct_rest(np.zeros((V, 3)), directions, features, correction)
    for v in range(V):
        for i in range(3):
            left = target[v, i] - b[v, i]
            for j in range(3):
                left -= A[v, i, j] * correction[v, j]
            for j in range(3):
                sides[v, j] += weight * A[v, i, j] * left
                for k in range(3):
                    squares[v, j, k] += weight * A[v, i, j] * A[v, i, k]


@njit(cache=True, nogil=True)
def _unpose(joints, parents, bones, weights, target, rotations, translation, rest):
    B, V = len(parents), len(target)
    Ts, posed = np.empty((B, 3, 4)), np.empty((B, 3))
    move_bones_into(Ts, posed, rotations, joints, parents, translation)
    A, b = np.empty((V, 3, 3)), np.empty((V, 3))
    blend(bones, weights, Ts, A, b)
    for v in range(V):
        rest[v] = np.linalg.solve(A[v], target[v] - b[v])
