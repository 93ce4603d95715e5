"""Rest joints of each person together with the poses of all their registrations.

[R17] keeps everything else constant while it improves the joints. Poses make up for wrong joints, so that alternation
hardly moves them; here the poses are eliminated from each step by their Schur complement (variable projection), which
lets the joints move as far as the poses would follow. What the registrations cannot tell, such as where along a hinge's
axis its joint lies, stays where the joint regressor puts it.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from tracker.training.linearize import linearize
from tracker.training.pose_fit import Hands, Poses, each
from tracker.training.rig import PosedHand, Rig, place_at, turn

Array = npt.NDArray[np.float64]

TOLERANCE = 1e-6
"""A person's fit ends when a step brings less than this share of the cost."""


def fit_joints(
    start: Poses,
    hands: Hands,
    expected: Array,
    stiffness: float,
    iterations: int,
    threads: int = 1,
    progress: Callable[[float], None] | None = None,
) -> tuple[Poses, Array]:
    """Poses and joints (S, B, 3), m, that bring the templates onto their targets.

    Args:
        start: Poses to begin with.
        hands: What is brought onto what; their joints are where to begin.
        expected: (S, B, 3) where the joints should be as far as registrations do not tell, m.
        stiffness: Weight of (joint - expected)² against that of one vertex, per registration.
        iterations: Steps for each person.
        progress: Told the share done; may raise to cancel.
    """
    rotations, translations = start.rotations.copy(), start.translations.copy()
    errors, found = start.errors.copy(), hands.joints.copy()

    def fit(person: int) -> None:
        mine = np.flatnonzero(hands.owners == person)
        if len(mine):
            pose = rotations[mine], translations[mine]
            template, joints = hands.templates[person], hands.joints[person]
            here, found[person] = _fit_person(
                pose, hands.targets[mine], template, joints, expected[person], stiffness, hands.rig, iterations
            )
            for n, hand in zip(mine, here, strict=True):
                rotations[n], translations[n] = hand.rotations, hand.translation
                errors[n] = np.sqrt(hand.cost / hands.targets.shape[1])

    each(fit, len(hands.templates), threads, progress)
    return Poses(rotations, translations, errors), found


def _fit_person(pose, targets, template, joints, expected, stiffness, rig: Rig, iterations):
    rotations, translations = pose
    B = len(joints)
    P, D = 3 * B + 3, 6 * B + 3
    stiff = stiffness * len(targets)

    def put(poses: list[tuple[Array, Array]], at: Array) -> list[PosedHand]:
        return [place_at(rig, template, at, pose, target) for pose, target in zip(poses, targets, strict=True)]

    def measure(hands: list[PosedHand], at: Array) -> float:
        return sum(hand.cost for hand in hands) + stiff * float(np.sum((at - expected) ** 2))

    H, g = np.empty((len(targets), D, D)), np.empty((len(targets), D))
    here = put(list(zip(rotations, translations, strict=True)), joints)
    total = measure(here, joints)
    for _ in range(iterations):
        for n, hand in enumerate(here):
            linearize(H[n], g[n], hand.arrays, rig.arrays, targets[n])
        own = H[:, :P, :P] + 1e-9 * np.eye(P)
        gains = np.linalg.solve(own, np.concatenate([H[:, :P, P:], g[:, :P, None]], axis=2))
        S = (H[:, P:, P:] - np.swapaxes(H[:, :P, P:], 1, 2) @ gains[:, :, :-1]).sum(0) + stiff * np.eye(3 * B)
        s = (g[:, P:] - np.einsum("npj,np->nj", H[:, :P, P:], gains[:, :, -1])).sum(0)
        s += stiff * (joints - expected).ravel()
        step = -np.linalg.solve(S, s)
        steps = -gains[:, :, -1] - gains[:, :, :-1] @ step
        for share in (1.0, 0.3, 0.1):
            at = joints + share * step.reshape(B, 3)
            moved = [turn(hand.rotations, hand.translation, share * steps[n]) for n, hand in enumerate(here)]
            there = put(moved, at)
            cost = measure(there, at)
            if cost < total:
                break
        else:
            break
        is_done = total - cost < TOLERANCE * total
        here, joints, total = there, at, cost
        if is_done:
            break
    return here, joints
