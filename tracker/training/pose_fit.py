"""The pose of each registration under a model whose rest shape is known, [R17] section 3.3."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.geometry.se3 import find_rotations
from tracker.solver.damped_step import compute_damped_step
from tracker.solver.minimize import minimize_damped
from tracker.training.linearize import linearize
from tracker.training.rig import PosedHand, Rig, place_at, turn

Array = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]

LONGEST_TURN = 0.5
"""Of a joint in one step about any axis, rad."""


@dataclass(frozen=True)
class Poses:
    """rotations (N, B, 3, 3) local; translations (N, 3) m; errors (N,) root mean square distance of vertices, m."""

    rotations: Array
    translations: Array
    errors: Array


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
    weights = rig.skinning_weights
    strongest = weights.argmax(axis=1)
    rotations = np.empty((N, B, 3, 3))
    for b in range(B):
        chosen = np.flatnonzero((strongest == b) & (weights[:, b] > 0.5))
        if len(chosen) < 4:
            chosen = np.flatnonzero(weights[:, b] > 0.0)
        source = templates[:, chosen] - templates[:, chosen].mean(1, keepdims=True)
        moved = targets[:, chosen] - targets[:, chosen].mean(1, keepdims=True)
        rotations[:, b] = find_rotations(np.einsum("nvi,nvj->nij", moved, source[owners]))
    local = rotations.copy()
    for b in range(1, B):
        local[:, b] = np.swapaxes(rotations[:, rig.parents[b]], 1, 2) @ rotations[:, b]
    palm = weights[:, 0] / weights[:, 0].sum()
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
    N, V = hands.targets.shape[:2]
    rotations, translations = start.rotations.copy(), start.translations.copy()
    errors = np.empty(N)

    def fit(n: int) -> None:
        hand = hands.templates[hands.owners[n]], hands.joints[hands.owners[n]]
        found = _fit(hands.rig, *hand, hands.targets[n], (rotations[n], translations[n]), iterations)
        rotations[n], translations[n] = found.rotations, found.translation
        errors[n] = np.sqrt(found.cost / V)

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


def _fit(
    rig: Rig, template: Array, joints: Array, target: Array, start: tuple[Array, Array], iterations: int
) -> PosedHand:
    D = 3 * len(joints) + 3
    limits = np.full(D, LONGEST_TURN)
    limits[3:6] = np.inf

    def find_equations(here: PosedHand) -> tuple[Array, Array]:
        H, g = np.empty((D, D)), np.empty(D)
        linearize(H, g, here.arrays, rig.arrays, target)
        return H, g

    def step(here: PosedHand, equations: tuple[Array, Array], damping: float) -> PosedHand:
        pose = turn(here.rotations, here.translation, compute_damped_step(*equations, damping, limits))
        return place_at(rig, template, joints, pose, target)

    first = place_at(rig, template, joints, start, target)
    return minimize_damped(first, find_equations, step, iterations, 1e-5)
