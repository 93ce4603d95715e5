"""Where the joints of a hand are in space, from what somebody marked in several cameras at once."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from server.compute import ComputeContext
from server.errors import InvalidError
from server.suggestions.triangulation_schemas import (
    TriangulatedJoint,
    TriangulatedView,
    TriangulationOut,
    TriangulationView,
)
from tracker import Camera
from tracker.capture import triangulate


def triangulate_hand(
    _context: ComputeContext, name: str, items: Sequence[dict[str, Any]], views: Sequence[TriangulationView]
) -> TriangulationOut:
    """The joints that two views or more have, and where every camera of the recording sees them."""
    cameras = {item["id"]: _open_camera(item) for item in items}
    named = [view.camera for view in views]
    if unknown := sorted(set(named) - set(cameras)):
        raise InvalidError(f"{name} has no camera {unknown[0]!r}; it has {', '.join(cameras)}.")
    if len(set(named)) != len(named):
        raise InvalidError("A camera is named twice. Send one view for each camera: all its 21 joints together.")
    points = np.array([view.points for view in views], dtype=np.float64)  # (C, 21, 3)
    marks = np.where(points[:, :, 2:] > 0, points[:, :, :2], np.nan).transpose(1, 0, 2)
    found = triangulate([cameras[name] for name in named], np.ascontiguousarray(marks))
    pixels = {name: camera.project(found.points) for name, camera in cameras.items()}
    is_seen = {name: camera.can_see(found.points) for name, camera in cameras.items()}

    def describe_view(joint: int, name: str) -> TriangulatedView:
        column = named.index(name) if name in named else None
        x, y = pixels[name][joint]
        return TriangulatedView(
            camera=name,
            x=_number(x, 4),
            y=_number(y, 4),
            is_seen=bool(is_seen[name][joint]),
            is_used=column is not None and bool(found.is_used[joint, column]),
            residual_px=None if column is None else _number(found.residuals[joint, column], 4),
            left_out_px=None if column is None else _number(found.left_out_residuals[joint, column], 4),
        )

    return TriangulationOut(
        joints=[
            TriangulatedJoint(
                point=None if refusal else [float(value) for value in found.points[joint]],
                angle_deg=_number(found.angles_deg[joint], 3),
                std_mm=_number(1000.0 * found.std_m[joint], 4),
                refusal=refusal,
                views=[describe_view(joint, name) for name in cameras],
            )
            for joint, refusal in enumerate(found.refusals)
        ]
    )


def _open_camera(item: dict[str, Any]) -> Camera:
    return Camera(
        item["id"],
        item["width"],
        item["height"],
        np.array(item["K"], dtype=np.float64),
        np.array(item["distortion"], dtype=np.float64),
        np.array(item["T_world_camera"], dtype=np.float64),
    )


def _number(value: float, digits: int) -> float | None:
    return round(float(value), digits) if np.isfinite(value) else None
