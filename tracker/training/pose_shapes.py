"""Pose blend shapes, [R17] Eq. 4, by ridge regression with a cost that grows with the distance from the joint, Eq. 10.

Differs from the paper: the cost is the square of the geodesic distance over 15 mm plus a constant, so that shapes at
the joint itself are held, too; its weight grows with the number of registrations and is chosen by leaving people out.
Each person's template is eliminated: what is explained is how the unposed registrations of one person differ, so that
templates and blend shapes need not wait for one another.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]

REACH = 0.015
"""Distance from a joint at which the cost is the usual one, m."""

FLOOR = 0.05
"""The part of the cost that does not depend on the distance."""

RIDGES = (1e-7, 3e-7, 1e-6, 3e-6, 1e-5, 3e-5, 1e-4)
"""Weights to choose from, per registration."""


@dataclass(frozen=True)
class PoseShapes:
    """directions (V, 3, 9K) m; ridge: the weight that was chosen; errors: by weight, on people left out, m."""

    directions: Array
    ridge: float
    errors: dict[float, float]


def compute_costs(distances: Array) -> Array:
    """(V, 9K) cost of each feature at each vertex, from geodesic distances (K, V) m, [R17] Eq. 10."""
    return np.repeat(((distances / REACH) ** 2 + FLOOR).T, 9, axis=1)


def fit_pose_shapes(
    features: Array,
    rest: Array,
    owners: Integers,
    people: Integers,
    costs: Array,
    ridges: tuple[float, ...] = RIDGES,
    folds: int = 4,
) -> PoseShapes:
    """Blend shapes that explain how unposed registrations of one person differ.

    Args:
        features: (N, 9K) of Eq. 4.
        rest: (N, V, 3) registrations unposed, m.
        owners: (N,) which template they are of.
        people: (N,) whose they are: a person may have two hands.
        costs: (V, 9K).
        ridges: To choose from by leaving people out; a single one is taken as it is.
        folds: So many groups of people.
    """
    phi, d = _centre(features, owners), _centre(rest.reshape(len(rest), -1), owners)
    names, places = np.unique(people, return_inverse=True)
    groups = places % min(folds, len(names))
    errors: dict[float, float] = {}
    ridge = ridges[0]
    if len(ridges) > 1 and len(names) > 1:
        sums = dict.fromkeys(ridges, 0.0)
        for group in np.unique(groups):
            train, test = groups != group, groups == group
            G, S = phi[train].T @ phi[train], phi[train].T @ d[train]
            for weight in ridges:
                P = _solve(G, S, weight * train.sum() * costs)
                sums[weight] += float(((d[test] - phi[test] @ P) ** 2).sum())
        errors = {weight: float(np.sqrt(total / d.size * 3)) for weight, total in sums.items()}
        ridge = min(sums, key=lambda weight: sums[weight])
    P = _solve(phi.T @ phi, phi.T @ d, ridge * len(phi) * costs)
    directions = np.ascontiguousarray(P.T.reshape(rest.shape[1], 3, -1))
    return PoseShapes(directions, ridge, errors)


def _centre(values: Array, owners: Integers) -> Array:
    """Each person's mean taken off."""
    centred = values.copy()
    for person in np.unique(owners):
        centred[owners == person] -= centred[owners == person].mean(0)
    return centred


def _solve(G: Array, S: Array, penalties: Array) -> Array:
    """(9K, 3V) ridge solutions: G (9K, 9K), S (9K, 3V), penalties (V, 9K), one system per vertex."""
    n, V = len(G), len(penalties)
    sides = S.reshape(n, V, 3).transpose(1, 0, 2)
    result = np.empty((V, n, 3))
    places = np.arange(n)
    for first in range(0, V, 64):
        part = penalties[first : first + 64]
        systems = np.broadcast_to(G, (len(part), n, n)).copy()
        systems[:, places, places] += part
        result[first : first + 64] = np.linalg.solve(systems, sides[first : first + 64])
    return result.transpose(1, 0, 2).reshape(n, 3 * V)
