"""What stands still around hands and object, and which way things fall; [T16] §3.2.6 models the static scene too."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tracker.capture.static_plane import StaticPlane
from tracker.physics.protocol import find_down

LEVEL = np.cos(np.deg2rad(60.0))
"""A plane is a table or a floor if its normal is within 60 degrees of the camera's own up; otherwise it is a wall, or
the camera looks straight down and only the recording can say where that is."""


@dataclass(frozen=True)
class StaticScene:
    """The static scene of a run.

    Attributes:
        down: (3,) unit direction of gravity, world.
        down_from: Who says so: `recording`, `plane` or `camera`.
        planes: Tables, floors, walls.
        planes_from: Who says so: `recording`, `depth` or `nobody`.
    """

    down: tuple[float, float, float]
    down_from: str = "camera"
    planes: tuple[StaticPlane, ...] = ()
    planes_from: str = "nobody"

    def to_json(self) -> dict[str, Any]:
        """As `setup.json` holds it."""
        return {
            "down": list(self.down),
            "down_from": self.down_from,
            "planes": [plane.to_json() for plane in self.planes],
            "planes_from": self.planes_from,
        }

    @classmethod
    def from_json(cls, values: dict[str, Any]) -> StaticScene:
        """From what `to_json` gave."""
        planes = tuple(StaticPlane(_triple(plane["point"]), _triple(plane["normal"])) for plane in values["planes"])
        return cls(_triple(values["down"]), str(values["down_from"]), planes, str(values["planes_from"]))


def choose_down(
    gravity: tuple[float, float, float] | None, planes: Sequence[StaticPlane], T_world_camera: np.ndarray
) -> tuple[tuple[float, float, float], str]:
    """Which way things fall, and who says so: the recording, else the first level plane, else the camera's +y.

    Args:
        gravity: (3,) unit, world, as the recording has it, or None.
        planes: Of the static scene.
        T_world_camera: (4, 4).
    """
    if gravity is not None:
        return gravity, "recording"
    upright = find_down(T_world_camera)
    for plane in planes:
        if -np.dot(plane.normal, upright) > LEVEL:
            x, y, z = plane.normal
            return (-x, -y, -z), "plane"
    return upright, "camera"


def _triple(values: Sequence[float]) -> tuple[float, float, float]:
    x, y, z = (float(value) for value in values)
    return x, y, z
