"""Where in the image a scene is to be looked for."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.geometry import se3
from tracker.observation import Region

MARGIN = 0.040
"""Room left around the scene in the image, m at its depth."""

FINENESS = 0.0012
"""Pixels need not be closer on the hand than this, m; on the recordings of [T16] they are 1.5 mm apart."""

SMALLEST = 16
"""A region with fewer rows or columns than this shows nothing of a hand."""

DEPTH_MARGIN = 0.060
"""Room left before and behind the scene, m."""


def region_around(vertices: npt.NDArray[np.float64], camera: Camera) -> Region | None:
    """The region of the image around vertices (V, 3) world, m; None if they are not in sight."""
    in_camera = se3.transform(camera.T_camera_world, vertices)
    depths = in_camera[:, 2]
    if depths.min() < 0.05:
        return None
    across, down = MARGIN / float(np.median(depths)) * camera.K[[0, 1], [0, 1]]
    columns = camera.K[0, 0] * in_camera[:, 0] / depths + camera.K[0, 2]
    rows = camera.K[1, 1] * in_camera[:, 1] / depths + camera.K[1, 2]
    first_column, first_row = max(0, int(columns.min() - across)), max(0, int(rows.min() - down))
    last_column = min(camera.width, int(columns.max() + across) + 1)
    last_row = min(camera.height, int(rows.max() + down) + 1)
    if last_column - first_column < SMALLEST or last_row - first_row < SMALLEST:
        return None
    return Region(
        first_row,
        first_column,
        last_row - first_row,
        last_column - first_column,
        max(0.05, float(depths.min()) - DEPTH_MARGIN),
        float(depths.max()) + DEPTH_MARGIN,
    )


def region_around_joints(
    points: npt.NDArray[np.float64],
    looked_at: npt.NDArray[np.float64],
    depth: npt.NDArray[np.float32],
    camera: Camera,
    margin: float,
    reach: float,
) -> Region | None:
    """The region of the image around the joints of a hand that are known in the image; None where no depth is at them.

    Args:
        points: (N, 2) px, of all joints that are known.
        looked_at: (M, 2) px, of those whose depth tells the hand's.
        depth: (H, W) m, 0 where there is none.
        camera: Undistorted.
        margin: Room around the joints, m.
        reach: Depth before and behind the hand, m.
    """
    columns = np.clip(np.rint(looked_at[:, 0]), 0, camera.width - 1).astype(int)
    rows = np.clip(np.rint(looked_at[:, 1]), 0, camera.height - 1).astype(int)
    depths = depth[rows, columns]
    depths = depths[depths > 0]
    if not depths.size:
        return None
    distance = float(np.median(depths))
    room = margin * camera.K[0, 0] / distance
    left, top = np.maximum(points.min(axis=0) - room, 0).astype(int).tolist()
    right, bottom = (np.minimum(points.max(axis=0) + room, (camera.width, camera.height))).astype(int).tolist()
    right, bottom = min(right + 1, camera.width), min(bottom + 1, camera.height)
    if right - left < SMALLEST or bottom - top < SMALLEST:
        return None
    return Region(top, left, bottom - top, right - left, max(0.05, distance - reach), distance + reach)


def is_outgrown(region: Region, needed: Region, camera: Camera) -> bool:
    """Whether a region that something was looked for in leaves out half of the room around the one that it needs.

    Then only part of it was seen, and nothing can be said about the rest.
    """
    room = 0.5 * MARGIN * camera.K[0, 0] / (0.5 * (needed.near + needed.far))
    missing = (
        region.row - needed.row,
        region.column - needed.column,
        needed.row + needed.height - region.row - region.height,
        needed.column + needed.width - region.column - region.width,
    )
    return max(missing) > room or max(region.near - needed.near, needed.far - region.far) > 0.5 * DEPTH_MARGIN


def choose_stride(region: Region, camera: Camera) -> int:
    """Of how many pixels one is enough to see a hand by in a region: cameras near by show more than a fit can use."""
    return max(1, round(FINENESS * float(camera.K[0, 0]) * 2.0 / (region.near + region.far)))


def depth_range(frame: Frame) -> tuple[float, float]:
    """Depths, m, between which hands are looked for in a frame of which nothing is known, [T16] §3.2.1.

    It ends 0.6 m behind the nearest thing of some size.
    """
    assert frame.depth is not None
    values = frame.depth[(frame.depth > 0.1) & (frame.depth < 3.0)]
    return (0.1, float(np.partition(values, 200)[200]) + 0.6) if values.size > 200 else (0.1, 3.0)


def whole_image(camera: Camera, near: float, far: float) -> Region:
    """The whole image between two depths, m."""
    return Region(0, 0, camera.height, camera.width, near, far)
