"""Whether contacts can carry an object's weight: forces within the friction cones against the wrench of gravity."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.optimize import nnls

from tracker.physics.protocol import PATCH_RADIUS

Array = npt.NDArray[np.float64]

CONE_EDGES = 8
"""Of the pyramid that stands for a cone of friction; it encloses the cone, so no grip is refused wrongly."""


def build_wrenches(points: Array, inward: Array, friction: float, centroid: Array, radius: float) -> Array:
    """Wrenches (6, N · 14) that contacts can press on an object with, torques about its centroid in units of `radius`.

    The friction cone is replaced by a pyramid around it, and the pressure may sit anywhere on a patch, so what a real
    contact can do is always among the sums of the columns: the test errs towards "can be held".

    Args:
        points: (N, 3) contacts, world, m.
        inward: (N, 3) unit normals into the object, world.
        friction: Coefficient between the two.
        centroid: (3,) of the object, world, m.
        radius: Of the object, m.
    """
    assert points.shape == inward.shape and points.shape[1:] == (3,)
    aside = np.eye(3)[np.argmin(np.abs(inward), axis=1)]
    first = np.cross(inward, aside)
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    second = np.cross(inward, first)
    turns = 2.0 * np.pi * np.arange(CONE_EDGES) / CONE_EDGES
    slope = friction / np.cos(np.pi / CONE_EDGES)
    tangents = np.cos(turns)[:, None] * first[:, None] + np.sin(turns)[:, None] * second[:, None]
    forces = inward[:, None] + slope * tangents
    arms = (points - centroid) / radius
    torques = np.cross(arms[:, None], forces)
    share = PATCH_RADIUS / radius
    twists = np.stack([slope * inward, -slope * inward, first, -first, second, -second], axis=1) * share
    patch_torques = np.cross(arms, inward)[:, None] + twists
    patch_forces = np.repeat(inward[:, None], 6, axis=1)
    columns = np.concatenate(
        [np.concatenate([forces, torques], axis=2), np.concatenate([patch_forces, patch_torques], axis=2)], axis=1
    )
    return np.asarray(columns.reshape(-1, 6).T, dtype=np.float64)


def find_imbalance(wrenches: Array, down: Array) -> float:
    """The share of the weight that no sum of the wrenches (6, M) carries: 0 held, 1 not at all.

    Non-negative least squares |W λ + (g, 0)|; a torque of the weight at one radius counts as much as the weight.
    """
    assert wrenches.shape[0] == 6 and down.shape == (3,)
    if wrenches.shape[1] == 0:
        return 1.0
    return float(nnls(wrenches, np.concatenate([-down, np.zeros(3)]))[1])
