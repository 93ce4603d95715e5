"""Try other bends of single fingers: descent gets stuck where two fingers claim one, a search does not."""

from __future__ import annotations

from collections.abc import Callable
from itertools import product

import numpy as np
import numpy.typing as npt

from tracker.model.articulated import ArticulatedModel
from tracker.model.joints import FINGERS

Array = npt.NDArray[np.float64]

BASE_CURLS, OUTER_CURLS = (0.0, 0.35, 0.7), (0.0, 0.4, 0.8)
"""Shares of the flexion of a finger's base and of its outer joints that are tried."""

SPREADS = (-0.8, -0.4, 0.0, 0.4, 0.8)
"""Shares of a finger's side-to-side limits that are tried."""

GAIN = 0.003
"""A change must raise the score by this."""


def search_fingers(pose: Array, first_dof: int, model: ArticulatedModel, score: Callable[[Array], float]) -> Array:
    """The pose with each finger in turn at the best of a few bends, the score never lower than before.

    Args:
        pose: (D,) of the scene.
        first_dof: Where the model's parameters begin in the pose.
        model: The hand.
        score: Of a pose (D,), higher is better.
    """
    best, best_score = pose, score(pose)
    for finger in range(len(FINGERS)):
        every, base, outer, spread = _finger_dofs(model, finger)
        far = _farther_limit(model)
        for curl, bend, side in product(BASE_CURLS, OUTER_CURLS, SPREADS if len(spread) else (0.0,)):
            trial = best.copy()
            angles = trial[first_dof + 6 : first_dof + model.num_dofs]
            angles[every] = 0.0
            angles[base], angles[outer] = curl * far[base], bend * far[outer]
            limit = model.skeleton.upper if side > 0 else -model.skeleton.lower
            angles[spread] = side * limit[spread]
            value = score(trial)
            if value > best_score + GAIN:
                best, best_score = trial, value
    return best


def swap_fingers(pose: Array, first_dof: int, model: ArticulatedModel) -> list[Array]:
    """Poses (D,) with two neighbouring fingers each bent as the other is, neither to its side.

    A finger that has taken its neighbour's place leaves that one only its own; descent cannot undo that.

    Args:
        pose: (D,) of the scene.
        first_dof: Where the model's parameters begin in the pose.
        model: The hand.
    """
    far = _farther_limit(model)
    poses = []
    for finger in range(1, len(FINGERS) - 1):
        swapped = pose.copy()
        old = pose[first_dof + 6 : first_dof + model.num_dofs]
        new = swapped[first_dof + 6 : first_dof + model.num_dofs]
        for one, other in ((finger, finger + 1), (finger + 1, finger)):
            every, *bends, _ = _finger_dofs(model, one)
            _, *others, _ = _finger_dofs(model, other)
            new[every] = 0.0
            for own, taken in zip(bends, others, strict=True):
                common = min(len(own), len(taken))
                own, taken = own[:common], taken[:common]
                new[own] = old[taken] / far[taken] * far[own]
        poses.append(swapped)
    return poses


def curl_fingers(model: ArticulatedModel, share: float) -> Array:
    """(K,) joint angles with every joint of a wide range at a share of its farther limit, rad."""
    return np.where(_is_wide(model), share * _farther_limit(model), 0.0)


def measure_curl(model: ArticulatedModel, angles: Array) -> float:
    """Mean share of their farther limit at which joints of a wide range (K,) stand: 0 an open hand, 1 a fist."""
    wide = _is_wide(model)
    return float(np.mean(np.clip(angles[wide] / _farther_limit(model)[wide], 0.0, 1.0)))


def list_finger_angles(model: ArticulatedModel, finger: int) -> npt.NDArray[np.intp]:
    """Indices into K of all joint angles of a finger, 0 the thumb."""
    return _finger_dofs(model, finger)[0]


def _finger_dofs(model: ArticulatedModel, finger: int) -> tuple[npt.NDArray, npt.NDArray, npt.NDArray, npt.NDArray]:
    """Joints (indices into K) of a finger: all, those that bend its base, its outer part, and those that spread it."""
    assert model.hand is not None
    bones = model.hand.joint_bones[1 + 4 * finger : 4 + 4 * finger]
    own = np.isin(model.skeleton.dof_bones, bones[bones >= 0])
    metacarpal = model.skeleton.parents[bones[0]]
    in_palm = (model.skeleton.dof_bones == metacarpal) & (model.skeleton.parents[metacarpal] >= 0)
    wide = _is_wide(model)
    span = model.skeleton.upper - model.skeleton.lower
    at_base = model.skeleton.dof_bones == bones[0]
    return (
        np.flatnonzero(own | in_palm),
        np.flatnonzero(at_base & wide),
        np.flatnonzero(own & wide & ~at_base),
        np.flatnonzero(at_base & ~wide & (span > np.deg2rad(15.0))),
    )


def _is_wide(model: ArticulatedModel) -> npt.NDArray[np.bool_]:
    return (model.skeleton.upper - model.skeleton.lower) > np.deg2rad(60.0)


def _farther_limit(model: ArticulatedModel) -> Array:
    lower, upper = model.skeleton.lower, model.skeleton.upper
    return np.where(np.abs(lower) > np.abs(upper), lower, upper)
