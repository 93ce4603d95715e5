"""The pose of each registration under a model whose rest shape is known, [R17] section 3.3."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from numba import njit

from tracker.training.linearize import linearize
from tracker.training.motion import SparseSkinning, turn

Array = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]


@dataclass(frozen=True)
class Poses:
    """rotations (N, B, 3, 3) local; translations (N, 3) m; errors (N,) root mean square distance of vertices, m."""

    rotations: Array
    translations: Array
    errors: Array


@dataclass(frozen=True)
class Rig:
    """What all registrations share: parents (B,), skinning, directions (V, 3, 9(B-1)) or (V, 3, 0)."""

    parents: Integers
    skinning: SparseSkinning
    directions: Array


@dataclass(frozen=True)
class Hands:
    """N registrations, and the S hands that are posed onto them.

    Attributes:
        targets: (N, V, 3) registrations, m; owners: (N,) which hand each is of.
        templates: (S, V, 3) m; joints: (S, B, 3) m, both at rest.
        rig: What the hands share.
    """

    targets: Array
    owners: Integers
    templates: Array
    joints: Array
    rig: Rig


def start_poses(hands: Hands) -> Poses:
    """Poses from each bone's own vertices: a rotation that lays them on the target's, without regard to joints.

    Needs no earlier pose and does not depend on lengths of fingers.
    """
    targets, owners, templates, joints, rig = hands.targets, hands.owners, hands.templates, hands.joints, hands.rig
    N, B = len(targets), len(rig.parents)
    strongest = rig.skinning.bones[:, 0]
    rotations = np.empty((N, B, 3, 3))
    for b in range(B):
        chosen = np.flatnonzero((strongest == b) & (rig.skinning.weights[:, 0] > 0.5))
        if len(chosen) < 4:
            chosen = np.flatnonzero((rig.skinning.bones == b).any(1) & (rig.skinning.weights[:, 0] > 0.0))
        source = templates[:, chosen] - templates[:, chosen].mean(1, keepdims=True)
        moved = targets[:, chosen] - targets[:, chosen].mean(1, keepdims=True)
        U, _, Vt = np.linalg.svd(np.einsum("nvi,nvj->nij", moved, source[owners]))
        U[:, :, 2] *= np.linalg.det(U @ Vt)[:, None]
        rotations[:, b] = U @ Vt
    local = rotations.copy()
    for b in range(1, B):
        local[:, b] = np.swapaxes(rotations[:, rig.parents[b]], 1, 2) @ rotations[:, b]
    weight = rig.skinning.weights * (rig.skinning.bones == 0)
    palm = weight.sum(1) / weight.sum()
    centres = np.einsum("v,svi->si", palm, templates)[owners]
    root = joints[owners, 0]
    translations = (
        np.einsum("v,nvi->ni", palm, targets) - root - np.einsum("nij,nj->ni", rotations[:, 0], centres - root)
    )
    return Poses(np.ascontiguousarray(local), translations, np.full(N, np.inf))


def fit_poses(
    start: Poses,
    hands: Hands,
    iterations: int,
    threads: int = 1,
    progress: Callable[[float], None] | None = None,
) -> Poses:
    """Poses that bring each template onto its targets in the least squares sense, by Levenberg-Marquardt.

    Args:
        start: Where to begin.
        hands: What is brought onto what.
        iterations: At most, each.
        progress: Told the share done; may raise to cancel.
    """
    rig, (N, V) = hands.rig, hands.targets.shape[:2]
    rotations, translations = start.rotations.copy(), start.translations.copy()
    errors = np.empty(N)

    def fit(n: int) -> None:
        cost = _fit(
            hands.templates[hands.owners[n]],
            hands.joints[hands.owners[n]],
            rig.parents,
            *rig.skinning,
            rig.directions,
            hands.targets[n],
            rotations[n],
            translations[n],
            iterations,
        )
        errors[n] = np.sqrt(cost / V)

    each(fit, N, threads, progress)
    return Poses(rotations, translations, errors)


def each(work: Callable[[int], None], count: int, threads: int, progress: Callable[[float], None] | None) -> None:
    """Call `work(n)` for all n, telling how far it is every hundred calls."""
    with ThreadPoolExecutor(threads) as pool:
        for first in range(0, count, 100):
            last = min(count, first + 100)
            for _ in pool.map(work, range(first, last)):
                pass
            if progress is not None:
                progress(last / count)


@njit(cache=True, nogil=True)
def _fit(template, joints, parents, bones, weights, directions, target, rotations, translation, iterations):
    """Levenberg-Marquardt; rotations and translation are changed in place. Returns the sum of squared distances, m²."""
    B = len(parents)
    D = 3 * B + 3
    H, g = np.empty((D, D)), np.empty(D)
    none, nothing = np.empty((0, 0)), np.empty(0)
    trial, moved = rotations.copy(), translation.copy()
    cost = linearize(
        template, joints, parents, bones, weights, directions, target, rotations, translation, False, H, g
    )  # fmt: skip
    damping = 1e-6
    for _ in range(iterations):
        gain = 0.0
        for _attempt in range(6):
            damped = H.copy()
            for a in range(D):
                damped[a, a] = H[a, a] * (1.0 + damping) + 1e-12
            step = -np.linalg.solve(damped, g)
            trial[:] = rotations
            moved[:] = translation
            for b in range(B):
                x, y, z = step[3 * b], step[3 * b + 1], step[3 * b + 2]
                size = np.sqrt(x * x + y * y + z * z)
                shrink = 1.0 if size < 0.5 else 0.5 / size
                turn(trial[b], shrink * x, shrink * y, shrink * z)
            for i in range(3):
                moved[i] += step[3 * B + i]
            new = linearize(
                template, joints, parents, bones, weights, directions, target, trial, moved, False, none, nothing
            )  # fmt: skip
            if new < cost:
                gain = cost - new
                cost = new
                rotations[:] = trial
                translation[:] = moved
                damping = max(1e-9, 0.1 * damping)
                break
            damping = max(1e-6, 10.0 * damping)
        if gain <= 1e-5 * cost:
            break
        linearize(template, joints, parents, bones, weights, directions, target, rotations, translation, False, H, g)
    return cost
