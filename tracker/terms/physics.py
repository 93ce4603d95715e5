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
from tracker.terms.point_plane import PointToPlane
from tracker.terms.point_point import PointToPoint
from tracker.terms.residual import FrameContext

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Physics:
    """Pull the nearest point of each chosen finger part to the object's surface: E = Σ |v_i(θ) − X_i|², [T16] Eq. 16.

    X_i is held fixed, so only the hand moves and the Jacobian is exact. With `moves_object` X_i(θ) follows the object
    and both give way: v_i and X_i are drawn to the point m between them with twice the weight. At the pose of the match
    2 |v − m|² + 2 |X − m|² is |v − X|², and so are its derivatives by hand and object; its curvature, which leaves the
    product of the two out, is an upper bound of the true one, so a step lowers E.

    Differs from the paper: a part that is inside the object counts as in contact and is left alone; drawing it out is
    the collision term's task.
    """

    contacts: tuple[Contact, ...] = ()
    """Chosen by `find_support`; none leaves nothing to do."""

    weight: float = 10.0
    """γ_ph (§4.2.1)."""

    to_plane: bool = False
    """Along the object's normal only, as Eq. 7 does, instead of point-to-point."""

    moves_object: bool = False
    """Whether the object gives way too."""

    draws_out: bool = False
    """Whether a part that is inside the object is drawn out to its surface, instead of being left alone."""

    def find(self, posed: PosedScene, context: FrameContext | None = None) -> PointToPoint | PointToPlane:
        """The nearest pair of each contact that is apart, or with `draws_out` of each; the image plays no part."""
        pairs = [find_closest_point(posed, c.hand, c.part, c.object) for c in self.contacts]
        pairs = [pair for pair in pairs if self.draws_out or pair.distance > 0.0]
        count = len(pairs)
        ids = np.array([pair.part_corners for pair in pairs], dtype=np.int32).reshape(count, 3)
        shares = np.array([pair.part_shares for pair in pairs]).reshape(count, 3)
        targets = np.array([pair.point for pair in pairs]).reshape(count, 3)
        normals = np.array([pair.normal for pair in pairs]).reshape(count, 3)
        weights = np.full(count, self.weight)
        if self.moves_object:
            corners = np.array([pair.corners for pair in pairs], dtype=np.int32).reshape(count, 3)
            middles = 0.5 * (targets + np.array([pair.part_point for pair in pairs]).reshape(count, 3))
            ids = np.concatenate([ids, corners])
            shares = np.concatenate([shares, np.array([pair.shares for pair in pairs]).reshape(count, 3)])
            targets, normals = np.tile(middles, (2, 1)), np.tile(normals, (2, 1))
            weights = np.full(2 * count, 2.0 * self.weight)
        if self.to_plane:
            return PointToPlane(ids, shares, targets, normals, weights)
        return PointToPoint(ids, shares, targets, weights)


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

    def find(self, posed: PosedScene, context: FrameContext | None = None) -> PointToPoint | PointToPlane:
        """The nearest pair of each finger part that should touch."""
        return Physics(find_support(self.world, posed, self.options).contacts, self.weight).find(posed, context)
