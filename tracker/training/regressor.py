"""The joint regressor J of [R17] Eq. 1: joints as weighted averages of few vertices, sparse and not negative."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.sparse import csr_array

from tracker.training.blend_weights import find_weights

Array = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]

STIFFNESS = 1e-8
"""Weight of Σw² against the mean squared distance, m²: (0.1 mm)², which decides between vertices that do as well."""

SMALLEST = 1e-3
"""Smaller weights are dropped."""


def fit_joint_regressor(templates: Array, joints: Array, skinning_weights: Array, parents: Integers) -> csr_array:
    """(B, V) weights, each row summing to 1.

    Args:
        templates: (S, V, 3) rest shapes, m.
        joints: (S, B, 3) m.
        skinning_weights: (V, B): a joint is averaged from vertices that follow its bone, or the parent of it.
        parents: (B,).
    """
    B, V = joints.shape[1], templates.shape[1]
    rows = np.zeros((B, V))
    for b in range(B):
        follow = skinning_weights[:, b] + (skinning_weights[:, parents[b]] if parents[b] >= 0 else 0.0)
        nearest = np.linalg.norm(templates - joints[:, None, b], axis=2).mean(0)
        chosen = np.flatnonzero(follow > 0.1)
        chosen = chosen[np.argsort(nearest[chosen], kind="stable")[:150]]
        if len(chosen) < 8:
            chosen = np.argsort(nearest, kind="stable")[:40]
        away = templates[:, chosen] - joints[:, None, b]
        gram = np.einsum("svi,swi->vw", away, away) / len(templates) + STIFFNESS * np.eye(len(chosen))
        weights = find_weights(gram, np.ones(len(chosen), dtype=bool))
        weights[weights < SMALLEST] = 0.0
        rows[b, chosen] = weights / weights.sum()
    return csr_array(rows)
