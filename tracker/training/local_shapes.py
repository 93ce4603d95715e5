"""Shape directions of parts of the hand, for people whom too few others were measured to describe.

Thirty people give thirty principal components, each of the whole hand: who has this one's thumb and that one's palm is
not among them. So the covariance of the templates is multiplied, pair of vertices by pair, by exp(-d² / 2 r²) of their
distance d (localised, as in ensemble filters and in the morphable models of Lüthi et al. 2018; the product of two
positive semidefinite matrices is one), and its principal directions across those of the whole hand follow them. [R17]
has the principal components alone.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.linalg import eigh
from scipy.spatial.distance import cdist

Array = npt.NDArray[np.float64]

REACH = 0.06
"""r, m: two fingers' width. 0.03 is worse, 0.1 as good, on people kept out of the training ones."""

LEAST_VARIANCE = 1e-10
"""Of the greatest: directions with less are rounding."""


def find_local_shapes(templates: Array, components: Array, count: int, reach: float = REACH) -> Array:
    """Directions (V, 3, S) per standard deviation, m, at most `count`, at right angles to the components.

    Args:
        templates: (P, V, 3) m.
        components: (C, 3 V) unit, at right angles to one another: those that the whole hands vary along.
        count: Most directions wanted.
        reach: Distance, m, over which vertices still vary together.
    """
    P, V, _ = templates.shape
    count = min(count, 3 * V)
    mean = templates.mean(0)
    offsets = (templates - mean).reshape(P, 3 * V)
    nearness = np.exp(-cdist(mean, mean, "sqeuclidean") / (2.0 * reach * reach))
    covariance = offsets.T @ offsets / max(P - 1, 1)
    covariance *= np.repeat(np.repeat(nearness, 3, axis=0), 3, axis=1)
    covariance -= components.T @ (components @ covariance)
    covariance -= (covariance @ components.T) @ components
    variances, directions = eigh(covariance, subset_by_index=[3 * V - count, 3 * V - 1])
    is_real = variances > LEAST_VARIANCE * max(float(variances[-1]), 1e-30)
    variances, directions = variances[is_real][::-1], directions[:, is_real][:, ::-1]
    largest = np.abs(directions).argmax(0)
    signs = np.sign(directions[largest, np.arange(len(variances))])
    return np.ascontiguousarray((directions * signs * np.sqrt(variances)).reshape(V, 3, len(variances)))
