"""A frame given by the scan's own shape: registered in it, a scan ends the same however it lies."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from tracker.capture.scan import Scan
from tracker.model.blend_model import BlendModel
from tracker.registration.hand_state import HandState
from tracker.registration.scan_points import ScanPoints

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class ScanFrame:
    """Where the frame lies: p_scan = R_scan_frame @ p_frame + origin.

    Attributes:
        R_scan_frame: (3, 3).
        origin: (3,) scan, m.
    """

    R_scan_frame: Array
    origin: Array

    def enter(self, points: Array) -> Array:
        """Points (N, 3), scan to frame, m."""
        return np.ascontiguousarray((points - self.origin) @ self.R_scan_frame)

    def leave(self, points: Array) -> Array:
        """Points (N, 3), frame to scan, m."""
        return points @ self.R_scan_frame.T + self.origin

    def enter_scan(self, scan: Scan) -> Scan:
        return replace(scan, points=self.enter(scan.points), normals=scan.normals @ self.R_scan_frame)

    def enter_points(self, points: ScanPoints) -> ScanPoints:
        return ScanPoints(self.enter(points.points), np.ascontiguousarray(points.normals @ self.R_scan_frame))

    def enter_state(self, model: BlendModel, state: HandState, side: str) -> HandState:
        """A hand's state, scan to frame; that of a left hand is the state of its image in the mirror x = 0."""
        R = self.R_scan_frame.T
        return _move(model, state, R, -R @ self.origin, side)

    def leave_state(self, model: BlendModel, state: HandState, side: str) -> HandState:
        """The same, frame to scan."""
        return _move(model, state, self.R_scan_frame, self.origin, side)


def find_scan_frame(points: Array) -> ScanFrame:
    """The frame of principal axes of points (N, 3), m.

    The longest axis is y, the next z; both point to where the points reach farther (their third moment is positive),
    and x is across. So the frame of the scan's mirror image is the mirror image x = 0 of the scan's.
    """
    origin = points.mean(axis=0)
    offsets = points - origin
    _, axes = np.linalg.eigh(offsets.T @ offsets)
    y, z = (axis if ((offsets @ axis) ** 3).sum() >= 0.0 else -axis for axis in (axes[:, 2], axes[:, 1]))
    return ScanFrame(np.stack([np.cross(y, z), y, z], axis=1), origin)


def _move(model: BlendModel, state: HandState, R: Array, t: Array, side: str) -> HandState:
    """The state whose vertices are R v + t, of the hand itself, not of its mirror image."""
    if side == "left":
        mirror = np.diag([-1.0, 1.0, 1.0])
        R, t = mirror @ R @ mirror, mirror @ t
    return state.moved(model, R, t)
