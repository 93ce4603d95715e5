"""A table, floor or wall that a recording names, and which way things fall in it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tracker.capture.document import Node

MAX_PLANES = 20
"""Of a recording; a bound of ours."""


@dataclass(frozen=True)
class StaticPlane:
    """A table, floor or wall: everything behind it is solid, so nothing can pass through it in one step.

    Attributes:
        point: (3,) on it, world, m.
        normal: (3,) unit, away from the solid side, world.
    """

    point: tuple[float, float, float]
    normal: tuple[float, float, float]

    def __post_init__(self) -> None:
        assert abs(float(np.linalg.norm(self.normal)) - 1.0) < 1e-6, "the normal must be of length 1"

    def to_json(self) -> dict[str, list[float]]:
        """Its entry in `sequence.json`."""
        return {"point": list(self.point), "normal": list(self.normal)}


def parse_plane(node: Node) -> StaticPlane:
    """A plane from its entry in `sequence.json`; its normal may be of any length."""
    point = node.get("point").vector(3, 1000.0)
    if point.shape != (3,):
        node.get("point").fail("three numbers, m")
    x, y, z = point.tolist()
    return StaticPlane((x, y, z), parse_direction(node.get("normal")))


def parse_direction(node: Node) -> tuple[float, float, float]:
    """A direction as a unit vector, from three numbers that are not all zero."""
    direction = node.vector(3, 1000.0)
    length = float(np.linalg.norm(direction))
    if direction.shape != (3,) or length < 1e-6:
        node.fail("three numbers that are not all zero: a direction in the world")
    x, y, z = (direction / length).tolist()
    return x, y, z
