"""What is left out of a scan: points inside a line that somebody drew, beyond a plane, of a green object."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from server.errors import InvalidError
from server.scans.geometry import CROPPED, LEFT_OUT
from server.scans.schemas import PlaneStroke, PolygonStroke, ScanCrop

if TYPE_CHECKING:
    from tracker import Scan

MOST_CORNERS_TOGETHER = 10_000
"""Of all strokes of a crop: it is computed while somebody waits."""

LEAST_LEFT = 500
"""Points that a crop must leave."""


def check_crop(crop: ScanCrop) -> None:
    """Raise when a crop can be read but not done."""
    corners = sum(len(stroke.corners) for stroke in crop.strokes if isinstance(stroke, PolygonStroke))
    if corners > MOST_CORNERS_TOGETHER:
        raise InvalidError(
            f"The strokes have {corners} corners together, more than {MOST_CORNERS_TOGETHER}. Draw fewer or send fewer "
            "corners of each."
        )
    for stroke in crop.strokes:
        if isinstance(stroke, PlaneStroke) and not np.linalg.norm(stroke.normal) > 1e-6:
            raise InvalidError("The plane's normal is zero; needed a direction.")


def find_cropped(scan: Scan, crop: ScanCrop) -> np.ndarray:
    """(N,) points that its strokes take away."""
    cropped = np.zeros(len(scan.points), bool)
    for stroke in crop.strokes:
        is_plane = isinstance(stroke, PlaneStroke)
        cropped |= find_beyond(scan.points, stroke) if is_plane else find_drawn(scan.points, stroke)
    return cropped


def find_flags(scan: Scan, crop: ScanCrop) -> np.ndarray:
    """(N,) uint8: which points are cropped, and which of the others are not registered: of an object, or loose bits."""
    from tracker import find_hand_points

    cropped = find_cropped(scan, crop)
    flags = np.where(cropped, CROPPED, 0).astype(np.uint8)
    if not cropped.all():
        of_hand, _ = find_hand_points(scan.select(~cropped), crop.drops_objects)
        flags[np.flatnonzero(~cropped)[~of_hand]] = LEFT_OUT
    return flags


def find_beyond(points: np.ndarray, plane: PlaneStroke) -> np.ndarray:
    """(N,) points on the side of the plane that its normal shows to."""
    return points @ np.array(plane.normal) > plane.offset


def find_drawn(points: np.ndarray, stroke: PolygonStroke) -> np.ndarray:
    """(N,) points that are removed by a line drawn in a view. Those behind the camera never are."""
    view = np.array(stroke.view).reshape(4, 4)
    clip = points @ view[:, :3].T + view[:, 3]
    is_seen = clip[:, 3] > 1e-9
    seen = np.flatnonzero(is_seen)
    device = clip[seen, :2] / clip[seen, 3:]
    removed = np.zeros(len(points), bool)
    inside = find_inside(device, np.array(stroke.corners))
    removed[seen] = inside if stroke.removes == "inside" else ~inside
    return removed


def find_inside(points: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """(N,) whether points (N, 2) lie inside a closed line, by the even-odd rule.

    The points are sorted by y once, so that each edge touches only those at its height.
    """
    order = np.argsort(points[:, 1], kind="stable")
    x, y = points[order, 0], points[order, 1]
    is_in = np.zeros(len(points), bool)
    for (x0, y0), (x1, y1) in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        if y0 == y1:
            continue
        first, end = np.searchsorted(y, [min(y0, y1), max(y0, y1)], side="left")
        at = slice(first, end)
        is_in[at] ^= x[at] < x0 + (y[at] - y0) * ((x1 - x0) / (y1 - y0))
    found = np.zeros(len(points), bool)
    found[order] = is_in
    return found
