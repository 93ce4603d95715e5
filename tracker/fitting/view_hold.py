"""How a fit in several views holds the hands: by joints where most are detected, else contours and the frame before."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tracker.fitting.view_hands import REACH, ViewHands
from tracker.terms.joint_prior import Regularization

MANY = 4
"""So many views or more hold a hand by its contours better than single joints do."""

TOLD = 0.7
"""Share of the joints of hands in view that a detector for photographs tells, and more: all. One that tells only what
it sees tells less; its few joints are held by contours, too."""


@dataclass(frozen=True)
class ViewHold:
    """How the last iterations of a frame, those with contours, hold the hands.

    Attributes:
        reach: Of joints in them, mm.
        iterations: So many.
        regularization: Weight of the pull to the frame before, in all iterations.
    """

    reach: float
    iterations: int
    regularization: float


BY_JOINTS = ViewHold(REACH, 4, Regularization.weight)
"""Contours are drawn again in each iteration, and the joints have brought them near."""

BY_CONTOURS = ViewHold(5.0, 8, 0.1)
"""Chosen on rendered views (benchmarks/results/rendered_views.md): a hidden finger that few joints tell of must not
run away. Where all joints are told in two views it does harm: `two_camera_rgb` is then followed in 370 frames in place
of 374."""

BY_FEW_CONTOURS = ViewHold(5.0, 8, 0.3)
"""Fewer views hide more fingers. With 0.1 in two rendered views 3.5 mm, with 0.3 2.7 mm."""


def choose_hold(seen: ViewHands) -> ViewHold:
    """By how many views there are, and how many joints they tell of the hands they see."""
    if len(seen.cameras) >= MANY:
        return BY_CONTOURS
    told = [np.isfinite(hand.points).all(axis=1).mean() for hands in seen.hands for hand in hands.values()]
    return BY_FEW_CONTOURS if told and np.mean(told) < TOLD else BY_JOINTS
