"""Edges of a part of a colour image, with their directions and their places to parts of a pixel."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt
from numba import njit

from tracker.capture.camera import Camera
from tracker.observation.image_part import frame_points

DIRECTIONS = 6
"""Bins of 30 degrees; an edge belongs to its own and to both neighbours, so that directions may differ by 30 to 60."""

WEAK, STRONG = 30.0, 90.0
"""Canny's thresholds, of 255 times 4 (Sobel)."""

SLACK = 1.25
"""px by which an edge's pixel may be farther from a point's pixel than its place is from the point: 0.5 + 0.71."""


@dataclass(frozen=True)
class ImageEdges:
    """Edges as an ideal pinhole camera would show them.

    Attributes:
        K: (3, 3) px; pixel (0, 0) is the part's first.
        T_world_camera: (4, 4).
        directions: (H, W) uint8, bit d set at an edge across which brightness changes in a direction of bin d or of a
            neighbour of it; 0 where there is no edge.
        places: (H, W, 2) float32 row and column, to parts of a pixel; of no meaning where there is no edge.
    """

    K: npt.NDArray[np.float64]
    T_world_camera: npt.NDArray[np.float64]
    directions: npt.NDArray[np.uint8]
    places: npt.NDArray[np.float32]


def find_image_edges(
    image: npt.NDArray[np.uint8], camera: Camera, points: npt.NDArray[np.float64], margin: float
) -> ImageEdges | None:
    """Edges around points of an image; None where they are out of sight.

    Args:
        image: (H, W, 3) as recorded.
        camera: Its camera.
        points: (N, 2) px of an ideal lens, around which edges are looked for.
        margin: px.
    """
    window = frame_points(camera, points, margin)
    if window is None:
        return None
    grey = cv2.GaussianBlur(cv2.cvtColor(np.ascontiguousarray(window.cut(image)), cv2.COLOR_RGB2GRAY), (3, 3), 0)
    dx, dy = (np.asarray(cv2.Sobel(grey, cv2.CV_16S, *order), dtype=np.int16) for order in ((1, 0), (0, 1)))
    is_edge = np.asarray(cv2.Canny(dx, dy, WEAK, STRONG), dtype=np.uint8)
    directions = np.zeros((window.height, window.width), dtype=np.uint8)
    places = np.empty((window.height, window.width, 2), dtype=np.float32)
    _place_into(directions, places, is_edge, dx, dy)
    return ImageEdges(window.K, camera.T_world_camera, directions, places)


@njit(cache=True, nogil=True)
def _place_into(directions, places, is_edge, dx, dy):
    """Write where, along the larger part of the gradient, it is strongest: by a parabola through three pixels.

    Args:
        directions: (H, W) uint8 out, as in `ImageEdges`; must come zeroed.
        places: (H, W, 2) float32 out, likewise.
        is_edge: (H, W) uint8, not 0 at an edge.
        dx, dy: (H, W) int16 gradient of the brightness.
    """
    height, width = is_edge.shape
    for row in range(height):
        for column in range(width):
            if is_edge[row, column] == 0:
                continue
            x, y = float(dx[row, column]), float(dy[row, column])
            down, across = (0, 1) if abs(x) >= abs(y) else (1, 0)
            r0, c0 = max(row - down, 0), max(column - across, 0)
            r1, c1 = min(row + down, height - 1), min(column + across, width - 1)
            before = np.hypot(float(dx[r0, c0]), float(dy[r0, c0]))
            after = np.hypot(float(dx[r1, c1]), float(dy[r1, c1]))
            curve = 2.0 * np.hypot(x, y) - before - after
            shift = min(max(0.5 * (after - before) / curve, -0.5), 0.5) if curve > 0.0 else 0.0
            places[row, column, 0] = row + down * shift
            places[row, column, 1] = column + across * shift
            own = int(np.arctan2(y, x) % np.pi * (DIRECTIONS / np.pi)) % DIRECTIONS
            for bin in (own - 1, own, own + 1):
                directions[row, column] |= np.uint8(1 << (bin % DIRECTIONS))


def sort_offsets(radius: int) -> npt.NDArray[np.int16]:
    """(N, 2) rows and columns of all pixels within a radius, px, of one; the nearest first, ties as they are read."""
    steps = np.arange(-radius, radius + 1)
    rows, columns = (grid.ravel() for grid in np.meshgrid(steps, steps, indexing="ij"))
    square = rows**2 + columns**2
    order = np.argsort(square, kind="stable")
    order = order[: int(np.count_nonzero(square <= radius**2))]
    return np.stack([rows[order], columns[order]], axis=1).astype(np.int16)


@njit(cache=True, nogil=True)
def find_nearest_edge(seen, y, x, direction, reach):
    """The edge of a direction that is nearest to a point: its row, its column and how far it is, px.

    Args:
        seen: directions (H, W) and places (H, W, 2) as in `ImageEdges`, offsets (N, 2) of `sort_offsets`.
        y, x: Row and column of the point, px.
        direction: Bin of the direction that is asked for.
        reach: px; with SLACK at most the radius of the offsets.

    Returns:
        Infinities where there is none within reach.
    """
    directions, places, offsets = seen
    height, width = directions.shape
    wanted = np.uint8(1 << direction)
    row, column = int(np.rint(y)), int(np.rint(x))
    found_y, found_x, least = np.inf, np.inf, np.inf
    farthest = reach + SLACK
    farthest *= farthest
    for k in range(len(offsets)):
        down, across = int(offsets[k, 0]), int(offsets[k, 1])
        if down * down + across * across > farthest:
            break
        r, c = row + down, column + across
        if r < 0 or c < 0 or r >= height or c >= width or not directions[r, c] & wanted:
            continue
        apart = np.hypot(places[r, c, 0] - y, places[r, c, 1] - x)
        if apart < least and apart <= reach:
            found_y, found_x, least = float(places[r, c, 0]), float(places[r, c, 1]), apart
            farthest = min(farthest, (apart + SLACK) * (apart + SLACK))
    return found_y, found_x, least
