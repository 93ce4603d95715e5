"""Skin that follows the fingers goes over into skin of the forearm that does not, without a crease."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from tracker.model.blend_model import BlendModel
from tracker.model.body_hands import BodyHand, body_hand
from tracker.model.decimation import limit_weights

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

BAND, NEAR = 0.045, 0.09
"""So far behind the hand fingers still move the skin, and so far on both sides it is looked at, m along the arm."""


def smooth_seams(model: BlendModel) -> BlendModel:
    """The body whose forearms follow the fingers a little where the hands are sewn on.

    The trained hand's weights give the thumb up to a fifth of the skin at its open border; the forearm had none, so
    that every turn of a finger bent the skin sharply there. Now the fingers' weights go on behind the border, as smooth
    as can be, and end at nothing. The hands stay as they are.
    """
    weights = model.skinning_weights.copy()
    for side in ("right", "left"):
        hand = body_hand(model, side)
        band, others, smoothest = find_smoothest(model, hand)
        fingers = np.clip(smoothest @ model.skinning_weights[np.ix_(others, hand.fingers)], 0.0, 1.0)
        rest = model.skinning_weights[band] * (1.0 - fingers.sum(axis=1))[:, None]
        rest[:, hand.fingers] = fingers
        weights[band] = limit_weights(rest)
    return replace(model, skinning_weights=weights / weights.sum(axis=1, keepdims=True))


def find_smoothest(model: BlendModel, hand: BodyHand) -> tuple[Ints, Ints, Array]:
    """How values behind a hand follow from those around, with the least bending.

    Returns:
        band: (R,) vertices of the forearm behind the hand.
        others: (O,) vertices on both sides of it.
        weights: (R, O).
    """
    along = (model.template[:, 0] - model.joints_of(model.template)[hand.wrist, 0]) * hand.outwards[0]
    border = float(along[hand.vertices].min())
    near = (along > border - NEAR) & (along < border + NEAR)
    faces = model.faces[near[model.faces].all(axis=1)]
    used, local = np.unique(faces, return_inverse=True)
    bending = _bending(model.template[used], local.reshape(-1, 3))
    is_band = (along[used] > border - BAND) & ~np.isin(used, hand.vertices)
    reached = np.flatnonzero(np.abs(bending[:, is_band]).sum(axis=1))
    weights = -np.linalg.lstsq(bending[np.ix_(reached, is_band)], bending[np.ix_(reached, ~is_band)], rcond=None)[0]
    return used[is_band], used[~is_band], weights


def _bending(points: Array, triangles: Ints) -> Array:
    """(N, N) cotangent Laplacian over the root of each vertex's area."""
    laplacian, areas = np.zeros((len(points), len(points))), np.zeros(len(points))
    for corner in range(3):
        a, b, c = (triangles[:, (corner + k) % 3] for k in range(3))
        u, v = points[b] - points[a], points[c] - points[a]
        double = np.linalg.norm(np.cross(u, v), axis=1)
        np.add.at(areas, a, double / 6.0)
        cotangent = 0.5 * np.einsum("fx,fx->f", u, v) / double
        for first, second in ((b, c), (c, b)):
            np.add.at(laplacian, (first, second), -cotangent)
            np.add.at(laplacian, (first, first), cotangent)
    return laplacian / np.sqrt(areas)[:, None]
