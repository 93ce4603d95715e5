"""Blend weights from registrations, [R17] Eq. 1: not negative, local, at most four bones per vertex."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from numba import njit

from tracker.model.skinning import MAX_WEIGHTS
from tracker.training.pose_fit import Poses
from tracker.training.rig import Rig, place

Array = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]


def fit_blend_weights(
    poses: Poses,
    targets: Array,
    templates: Array,
    owners: Integers,
    joints: Array,
    rig: Rig,
    stiffness: float,
) -> Array:
    """The weights (V, B) that bring the templates onto their targets in the least squares sense.

    A vertex may follow the bone it follows most and the neighbours of that bone in the skeleton.

    Args:
        poses: Of the N registrations.
        targets: (N, V, 3) m; templates (S, V, 3) m; owners (N,); joints (S, B, 3) m.
        rig: The weights so far, and the blend shapes.
        stiffness: Weight of the square of what changes, mm² per registration.
    """
    V, B = targets.shape[1], len(rig.parents)
    grams = np.zeros((V, B, B))
    for n, person in enumerate(owners):
        posed = place(rig, templates[person], joints[person], poses.rotations[n], poses.translations[n])
        moved = posed.rest @ posed.Ts[:, :, :3].transpose(0, 2, 1) + posed.Ts[:, None, :, 3]  # (B, V, 3)
        away = (moved - targets[n]).transpose(1, 0, 2)
        grams += away @ away.transpose(0, 2, 1)
    grams *= 1e6 / len(targets)
    so_far = rig.skinning_weights
    near = np.eye(B, dtype=bool)
    for b, parent in enumerate(rig.parents):
        if parent >= 0:
            near[b, parent] = near[parent, b] = True
    allowed = near[np.argmax(so_far, axis=1)]
    weights = np.empty((V, B))
    for v in range(V):
        pull = np.eye(B) - so_far[v][:, None]
        gram = grams[v] + stiffness * pull.T @ pull
        w = find_weights(gram, allowed[v])
        if np.count_nonzero(w) > MAX_WEIGHTS:
            w = find_weights(gram, w >= np.sort(w)[-MAX_WEIGHTS])
        weights[v] = w
    return weights


def find_weights(gram: Array, allowed: npt.NDArray[np.bool_]) -> Array:
    """The w >= 0 with sum 1 that minimises wᵀ G w, zero where not allowed.

    Found as u / Σu of the u >= 0 that minimises uᵀ G u / 2 - Σu, whose conditions are the same up to scale.
    """
    chosen = np.flatnonzero(allowed)
    part = gram[np.ix_(chosen, chosen)]
    part = part + 1e-9 * max(float(np.trace(part)), 1e-12) / len(chosen) * np.eye(len(chosen))
    u = solve_nonnegative(part, np.ones(len(chosen)))
    weights = np.zeros(len(gram))
    weights[chosen] = u / u.sum()
    return weights


@njit(cache=True, nogil=True)
def solve_nonnegative(G, c):
    """The u >= 0 that minimises uᵀ G u / 2 - cᵀ u, G definite (C. L. Lawson and R. J. Hanson, 1974, ch. 23)."""
    n = len(c)
    u, is_free = np.zeros(n), np.zeros(n, dtype=np.bool_)
    scale = 0.0
    for i in range(n):
        scale = max(scale, abs(c[i]))
    for _ in range(10 * n):
        gradient = c - G @ u
        best = -1
        for i in range(n):
            if not is_free[i] and gradient[i] > 1e-10 * scale and (best < 0 or gradient[i] > gradient[best]):
                best = i
        if best < 0:
            break
        is_free[best] = True
        while True:
            free = np.flatnonzero(is_free)
            part, side = np.empty((len(free), len(free))), np.empty(len(free))
            for i in range(len(free)):
                side[i] = c[free[i]]
                for j in range(len(free)):
                    part[i, j] = G[free[i], free[j]]
            z = np.linalg.solve(part, side)
            share = 1.0
            for i in range(len(free)):
                if z[i] <= 0.0:
                    share = min(share, u[free[i]] / (u[free[i]] - z[i]) if u[free[i]] > z[i] else 0.0)
            for i in range(len(free)):
                u[free[i]] += share * (z[i] - u[free[i]])
            if share == 1.0:
                break
            for i in range(len(free)):
                if z[i] <= 0.0 and u[free[i]] <= 1e-14 * max(1.0, abs(z[i])):
                    u[free[i]] = 0.0
                    is_free[free[i]] = False
            if not is_free.any():
                break
    return u
