"""Pose blend shapes, [R17] Eq. 4, by ridge regression with a cost that grows with the distance from the joint, Eq. 10.

Differs from the paper: the cost is the square of the straight distance over 15 mm plus a constant, so that shapes at
the joint itself are held, too (the paper's distance is geodesic: docs/journal.md); its weight grows with the
number of registrations.
Each person's template is eliminated: what is explained is how the unposed registrations of one person differ, so that
templates and blend shapes need not wait for one another.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from numba import njit
from scipy.sparse import csr_array
from scipy.spatial.distance import cdist

Array = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]

REACH = 0.015
"""Distance from a joint at which the cost is the usual one, m."""

FLOOR = 0.05
"""The part of the cost that does not depend on the distance."""

RIDGE = 1e-4
"""Weight of the costs, per registration: chosen on generated people 26 to 31 (docs/journal.md)."""


def measure_from_joints(template: Array, regressor: csr_array) -> Array:
    """(B-1, V) mean distance from the vertices that a joint is averaged from, m, [R17] Eq. 10; the root is left out.

    Args:
        template: (V, 3) m.
        regressor: (B, V) rows that sum to 1.
    """
    weights = regressor.toarray()[1:]
    sources = np.flatnonzero(weights.any(0))
    return weights[:, sources] @ cdist(template[sources], template)


def compute_costs(distances: Array) -> Array:
    """(V, 9K) cost of each feature at each vertex, from distances (K, V) m, [R17] Eq. 10."""
    return np.repeat(((distances / REACH) ** 2 + FLOOR).T, 9, axis=1)


def fit_pose_shapes(features: Array, rest: Array, owners: Integers, costs: Array, ridge: float) -> Array:
    """Directions (V, 3, 9K), m, that explain how unposed registrations of one hand differ.

    Args:
        features: (N, 9K) of Eq. 4.
        rest: (N, V, 3) registrations unposed, m.
        owners: (N,) which hand they are of.
        costs: (V, 9K).
        ridge: Weight of the costs, per registration.
    """
    phi, d = _centre(features, owners), _centre(rest.reshape(len(rest), -1), owners)
    P = _solve(phi.T @ phi, phi.T @ d, ridge * len(phi) * costs)
    return np.ascontiguousarray(P.T.reshape(rest.shape[1], 3, -1))


def _centre(values: Array, owners: Integers) -> Array:
    """Each hand's mean taken off."""
    centred = values.copy()
    for person in np.unique(owners):
        centred[owners == person] -= centred[owners == person].mean(0)
    return centred


def _solve(G: Array, S: Array, penalties: Array) -> Array:
    """(9K, 3V) ridge solutions: G (9K, 9K), S (9K, 3V), penalties (V, 9K), one system per vertex.

    By a Cholesky decomposition of our own: LAPACK shares systems this small out among its threads, which costs ten
    times what it gains, and more beside other work.
    """
    n, V = len(G), len(penalties)
    solutions = np.ascontiguousarray(S.reshape(n, V, 3).transpose(1, 2, 0))
    _solve_in_place(np.ascontiguousarray(G), np.ascontiguousarray(penalties), solutions)
    return solutions.transpose(2, 0, 1).reshape(n, 3 * V)


@njit(cache=True, nogil=True, fastmath={"reassoc", "contract"})
def _solve_in_place(G, penalties, sides):
    """(G + diag(penalties_v)) x = sides_v for all v: sides (V, 3, n) become the solutions."""
    n = len(G)
    L = np.zeros((n, n))
    for v in range(len(penalties)):
        for i in range(n):
            for j in range(i + 1):
                total = G[i, j]
                for k in range(j):
                    total -= L[i, k] * L[j, k]
                L[i, j] = total / L[j, j] if j < i else np.sqrt(total + penalties[v, i])
        for c in range(sides.shape[1]):
            x = sides[v, c]
            for i in range(n):
                total = x[i]
                for k in range(i):
                    total -= L[i, k] * x[k]
                x[i] = total / L[i, i]
            for i in range(n - 1, -1, -1):
                x[i] /= L[i, i]
                for k in range(i):
                    x[k] -= L[i, k] * x[i]
