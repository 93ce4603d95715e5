"""The object as one rigid body: a base and the hulls that hang on it by fixed joints."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.physics.hulls import BoneHull

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class MovingBody:
    """What Bullet is given for the object.

    Hulls that nothing is near to cannot collide; together they are a base without a shape, of their mass and inertia.
    So a rope of 36 bones that is held at four of them is a body of five parts.

    Attributes:
        base: Place of the hull that is the base, or -1 when the base is a lump of hulls far from everything.
        links: Places of the hulls that hang on it.
        R: (3, 3) of the base, world; its axes are the principal ones.
        center: (3,) of the base's mass, world, m.
        mass: Of the base, kg.
        inertia: (3,) of the base about its axes, kg m².
    """

    base: int
    links: tuple[int, ...]
    R: Array
    center: Array
    mass: float
    inertia: Array


def build_moving_body(
    hulls: Sequence[BoneHull], Rs: Array, centers: Array, masses: Array, is_near: npt.NDArray[np.bool_]
) -> MovingBody:
    """The body of an object in its current shape.

    Args:
        hulls: M, the largest first.
        Rs: (M, 3, 3) world.
        centers: (M, 3) world, m.
        masses: (M,) kg.
        is_near: (M,) whether something may touch the hull.
    """
    assert len(hulls) == len(Rs) == len(centers) == len(masses) == len(is_near)
    far = np.flatnonzero(~is_near)
    links = tuple(int(place) for place in np.flatnonzero(is_near))
    if not len(far):
        return MovingBody(0, links[1:], Rs[0], centers[0], float(masses[0]), masses[0] * hulls[0].inertia_per_mass)
    mass = float(masses[far].sum())
    center = masses[far] @ centers[far] / mass
    inertia = np.zeros((3, 3))
    for place in far.tolist():
        arm = centers[place] - center
        turned = (Rs[place] * hulls[place].inertia_per_mass) @ Rs[place].T
        inertia += masses[place] * (turned + (arm @ arm) * np.eye(3) - np.outer(arm, arm))
    moments, axes = np.linalg.eigh(inertia)
    axes[:, 0] *= np.sign(np.linalg.det(axes))
    return MovingBody(-1, links, axes, center, mass, moments)
