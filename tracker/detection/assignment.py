"""Which detection is which fingertip of the model, [T16] Eq. 14."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.optimize import linear_sum_assignment

Array = npt.NDArray[np.float64]


def assign_detections(distances: Array, weights: Array, rejection: float) -> npt.NDArray[np.int64]:
    """The fingertip of each detection (S,), -1 for a false positive: the minimum of

        Σ_st e_st w_st + λ Σ_s α_s w_s + λ Σ_t β_t,   every detection and every fingertip used once, [T16] Eq. 14.

    Solved exactly as a linear assignment of S + T to S + T: each detection has a virtual fingertip of its own at
    cost λ w_s, each fingertip a virtual detection at cost λ (Table 1), and virtual nodes meet for nothing.

    Args:
        distances: (S, T) w_st; inf where a pair is impossible.
        weights: (S,) w_s: 1, or confidence over threshold.
        rejection: λ, in the unit of the distances.
    """
    detections, fingertips = distances.shape
    assert weights.shape == (detections,)
    costs = np.full((detections + fingertips, detections + fingertips), np.inf)
    costs[:detections, :fingertips] = distances
    costs[np.arange(detections), fingertips + np.arange(detections)] = rejection * weights
    costs[detections + np.arange(fingertips), np.arange(fingertips)] = rejection
    costs[detections:, fingertips:] = 0.0
    _, columns = linear_sum_assignment(costs)
    found = columns[:detections]
    return np.where(found < fingertips, found, -1).astype(np.int64)
