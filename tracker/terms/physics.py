"""Bring the finger parts that hold an object into contact with it, [T16] §3.2.6, Eq. 16."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from tracker.model.scene import PosedScene
from tracker.physics import Contact, PhysicsWorld, SupportOptions, find_support
from tracker.physics.closest_points import find_closest_point
from tracker.terms.look import TermLook
from tracker.terms.point_point import PointToPoint
from tracker.terms.residual import FrameContext

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Physics:
    """Pull the nearest point of each chosen finger part to the object's surface: E = Σ |v_i(θ) − X_i|², [T16] Eq. 16.

    X_i is held fixed, so only the hand moves and the Jacobian is exact.

    Differs from the paper: a part that is inside the object counts as in contact and is left alone; drawing it out is
    the collision term's task.
    """

    contacts: tuple[Contact, ...] = ()
    """Chosen by `find_support`; none leaves nothing to do."""

    weight: float = 10.0
    """γ_ph (§4.2.1)."""

    draws_out: bool = False
    """Whether a part that is inside the object is drawn out to its surface, instead of being left alone."""

    def find(self, posed: PosedScene, context: FrameContext | None = None) -> PointToPoint:
        """The nearest pair of each contact that is apart, or with `draws_out` of each; the image plays no part."""
        pairs = [find_closest_point(posed, c.hand, c.part, c.object) for c in self.contacts]
        pairs = [pair for pair in pairs if self.draws_out or pair.distance > 0.0]
        count = len(pairs)
        ids = np.array([pair.part_corners for pair in pairs], dtype=np.int32).reshape(count, 3)
        shares = np.array([pair.part_shares for pair in pairs]).reshape(count, 3)
        targets = np.array([pair.point for pair in pairs]).reshape(count, 3)
        return PointToPoint(ids, shares, targets, np.full(count, self.weight))


@dataclass(frozen=True)
class Supported:
    """`Physics` with the contacts that hold the object at the pose of each look: in every iteration, [T16] Algorithm 1.

    At each look the pose is simulated; an object that stays needs no contacts (§3.2.6).
    """

    look: ClassVar[TermLook] = TermLook("physics", "Physics", "#965aff", "#8778d2", (8, 3, 2, 3))

    world: PhysicsWorld
    """Of the scene that is fitted."""

    weight: float = 10.0
    """γ_ph (§4.2.1)."""

    options: SupportOptions = field(default_factory=SupportOptions)
    """How contacts are looked for."""

    def find(self, posed: PosedScene, context: FrameContext | None = None) -> PointToPoint:
        """The nearest pair of each finger part that should touch."""
        return Physics(find_support(self.world, posed, self.options).contacts, self.weight).find(posed, context)
