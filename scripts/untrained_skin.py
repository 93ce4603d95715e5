"""What moves the untrained hand's surface: blend weights that people drew, and a joint regressor to fit."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy import sparse
from scipy.optimize import nnls

from tracker.model.articulated import ArticulatedModel
from tracker.model.blend_model import BLEND_JOINTS
from tracker.model.decimation import find_surface_points, limit_weights
from tracker.model.joints import HAND_JOINTS

Array = npt.NDArray[np.float64]

PLACES = ("mcp", "pip", "dip")
THUMB_PLACES = ("cmc", "mcp", "ip")

RING = 48
"""Vertices near a joint that its regressor may use."""
REGRESSOR_RIDGE = 1e-4
"""Price of a large weight beside the misfit of the joint, both in m."""


def drawn_weights(hand: ArticulatedModel, vertices: Array) -> Array:
    """(V, B) the default hand's blend weights, which people drew, where the vertices (V, 3) m lie on its surface.

    Bones in MANO's order; the fingers' metacarpals are the wrist's.
    """
    assert hand.hand is not None
    bones = [int(hand.hand.joint_bones[HAND_JOINTS.index(find_landmark(name))]) for name in BLEND_JOINTS]
    weights = hand.skinning_weights[:, bones]
    weights[:, 0] += np.delete(hand.skinning_weights, bones, axis=1).sum(axis=1)
    return limit_weights(find_surface_points(vertices, hand.vertices, hand.faces).interpolate(weights))


def find_landmark(name: str) -> str:
    """Of HAND_JOINTS, for one of BLEND_JOINTS such as "index2"."""
    if name == "wrist":
        return name
    finger, number = name[:-1], int(name[-1]) - 1
    return f"{finger}_{(THUMB_PLACES if finger == 'thumb' else PLACES)[number]}"


def fit_joint_regressor(
    vertices: Array, joints: Array, directions: Array, joint_directions: Array, ring: int = RING
) -> sparse.csr_array:
    """(B, V) weights >= 0 that sum to one and follow the joints in every shape.

    Args:
        vertices: (V, 3) m.
        joints: (B, 3) m.
        directions: (V, 3, S) m.
        joint_directions: (B, 3, S) m.
        ring: So many of the vertices nearest to a joint may be used.
    """
    rows, columns, values = [], [], []
    for b, joint in enumerate(joints):
        near = np.argsort(np.linalg.norm(vertices - joint, axis=1))[:ring]
        system = np.concatenate(
            [vertices[near].T, directions[near].reshape(ring, -1).T, np.ones((1, ring)), REGRESSOR_RIDGE * np.eye(ring)]
        )
        wanted = np.concatenate([joint, joint_directions[b].ravel(), [1.0], np.zeros(ring)])
        found, _ = nnls(system, wanted)
        used = np.flatnonzero(found > 1e-4)
        rows += [b] * len(used)
        columns += near[used].tolist()
        values += (found[used] / found[used].sum()).tolist()
    return sparse.csr_array((values, (rows, columns)), shape=(len(joints), len(vertices)))
