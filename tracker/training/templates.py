"""Personalised templates: each person's own rest shape, [R17] section 3.3."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from tracker.model.skinning import blend_motions, take_back
from tracker.training.pose_fit import Poses
from tracker.training.rig import Rig, place

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
    nowhere = np.zeros((V, 3))
    for n, person in enumerate(owners):
        posed = place(rig, nowhere, joints[person], poses.rotations[n], poses.translations[n])  # its blend shapes alone
        A = blend_motions(rig.skinning_weights, posed.Ts)[:, :, :3]
        squares[person] += weights[n] * (A.transpose(0, 2, 1) @ A)
        sides[person] += weights[n] * np.einsum("vij,vi->vj", A, targets[n] - posed.vertices)
    return np.asarray(np.linalg.solve(squares, sides[..., None])[..., 0], dtype=np.float64)


def unpose(poses: Poses, targets: Array, owners: Integers, joints: Array, rig: Rig) -> Array:
    """(N, V, 3) the targets in the rest pose, m: what template and blend shapes together should be."""
    rest, nowhere = np.empty_like(targets), np.zeros(targets.shape[1:])
    for n, person in enumerate(owners):
        posed = place(rig, nowhere, joints[person], poses.rotations[n], poses.translations[n])
        rest[n] = take_back(blend_motions(rig.skinning_weights, posed.Ts), targets[n])
    return rest
