"""What moves the untrained hand's surface: skinning by distance along bones, and a joint regressor to fit."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy import sparse
from scipy.optimize import nnls

from tracker.model.blend_model import BLEND_PARENTS

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

FALLOFF = 4.0
"""A bone's weight is its distance to this power, inverted."""
MOST_BONES = 4
RING = 48
"""Vertices near a joint that its regressor may use."""
REGRESSOR_RIDGE = 1e-4
"""Price of a large weight beside the misfit of the joint, both in m."""


def skinning_weights(vertices: Array, joints: Array, tips: Array) -> Array:
    """(V, B) by the distance to each bone, among the nearest bone and those it hangs together with.

    Args:
        vertices: (V, 3) m.
        joints: (B, 3) in MANO's order, m.
        tips: (5, 3) thumb..little, m.
    """
    bones = len(joints)
    distances = np.full((len(vertices), bones), np.inf)
    for bone, start, end in bone_segments(joints, tips):
        distances[:, bone] = np.minimum(distances[:, bone], _distance(vertices, start, end))
    nearest = distances.argmin(axis=1)
    linked = np.eye(bones, dtype=bool)
    for bone, parent in enumerate(BLEND_PARENTS):
        if parent >= 0:
            linked[bone, parent] = linked[parent, bone] = True
    weights = np.where(linked[nearest], distances**-FALLOFF, 0.0)
    least = np.sort(weights, axis=1)[:, -MOST_BONES][:, None]
    weights = np.where(weights >= least, weights, 0.0)
    weights /= weights.sum(axis=1, keepdims=True)
    weights[weights < 0.01] = 0.0
    return weights / weights.sum(axis=1, keepdims=True)


def bone_segments(joints: Array, tips: Array) -> list[tuple[int, Array, Array]]:
    """Bone, start and end; the wrist's are the forearm and the lines to the knuckles, but not to the thumb's base."""
    forward = joints[4] - joints[0]
    segments = [(0, joints[0], joints[0] - 0.5 * forward)]
    for first, tip in ((1, 1), (4, 2), (7, 4), (10, 3), (13, 0)):
        chain = [*joints[first : first + 3], tips[tip]]
        if first != 13:
            segments.append((0, joints[0], joints[first]))
        segments += [(first + n, chain[n], chain[n + 1]) for n in range(3)]
    return segments


def fit_joint_regressor(vertices: Array, joints: Array, directions: Array, joint_directions: Array) -> sparse.csr_array:
    """(B, V) weights >= 0 that sum to one and follow the joints in every shape.

    Args:
        vertices: (V, 3) m.
        joints: (B, 3) m.
        directions: (V, 3, S) m.
        joint_directions: (B, 3, S) m.
    """
    rows, columns, values = [], [], []
    for b, joint in enumerate(joints):
        near = np.argsort(np.linalg.norm(vertices - joint, axis=1))[:RING]
        system = np.concatenate(
            [vertices[near].T, directions[near].reshape(RING, -1).T, np.ones((1, RING)), REGRESSOR_RIDGE * np.eye(RING)]
        )
        wanted = np.concatenate([joint, joint_directions[b].ravel(), [1.0], np.zeros(RING)])
        found, _ = nnls(system, wanted)
        used = np.flatnonzero(found > 1e-4)
        rows += [b] * len(used)
        columns += near[used].tolist()
        values += (found[used] / found[used].sum()).tolist()
    return sparse.csr_array((values, (rows, columns)), shape=(len(joints), len(vertices)))


def _distance(points: Array, start: Array, end: Array) -> Array:
    along = end - start
    share = np.clip((points - start) @ along / (along @ along), 0.0, 1.0)
    return np.maximum(np.linalg.norm(points - start - share[:, None] * along, axis=1), 1e-4)
