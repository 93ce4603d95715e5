"""Edges of a part of a colour image, and for every pixel the nearest of each direction."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.observation.image_part import frame_points

DIRECTIONS = 6
"""Bins of 30 degrees; an edge belongs to its own and to both neighbours, so that directions may differ by 30 to 60."""

WEAK, STRONG = 30.0, 90.0
"""Canny's thresholds, of 255 times 4 (Sobel)."""


@dataclass(frozen=True)
class ImageEdges:
    """Edges as an ideal pinhole camera would show them.

    Attributes:
        K: (3, 3) px; pixel (0, 0) is the part's first.
        T_world_camera: (4, 4).
        nearest: (DIRECTIONS, H, W, 2) float32 row and column, to parts of a pixel, of the nearest edge across which
            brightness changes in a direction of that bin; NaN where there is none.
    """

    K: npt.NDArray[np.float64]
    T_world_camera: npt.NDArray[np.float64]
    nearest: npt.NDArray[np.float32]


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
    width, height, part = window.width, window.height, window.cut(image)
    grey = cv2.GaussianBlur(cv2.cvtColor(np.ascontiguousarray(part), cv2.COLOR_RGB2GRAY), (3, 3), 0)
    dx, dy = (cv2.Sobel(grey, cv2.CV_16S, *order).astype(np.int16) for order in ((1, 0), (0, 1)))
    rows, columns = np.nonzero(cv2.Canny(dx, dy, WEAK, STRONG))
    places = _refine(dx, dy, rows, columns)
    angle = np.arctan2(dy[rows, columns].astype(np.float32), dx[rows, columns].astype(np.float32)) % np.pi
    bins = (angle * (DIRECTIONS / np.pi)).astype(np.int8) % DIRECTIONS
    nearest = np.full((DIRECTIONS, height, width, 2), np.nan, dtype=np.float32)
    for direction in range(DIRECTIONS):
        beside = (bins - direction) % DIRECTIONS
        chosen = (beside <= 1) | (beside == DIRECTIONS - 1)
        _nearest_into(nearest[direction], rows[chosen], columns[chosen], places[chosen])
    return ImageEdges(window.K, camera.T_world_camera, nearest)


def _refine(
    dx: npt.NDArray[np.int16], dy: npt.NDArray[np.int16], rows: npt.NDArray[np.intp], columns: npt.NDArray[np.intp]
) -> npt.NDArray[np.float32]:
    """(N, 2) row and column where the gradient (H, W) is strongest near pixels (N,), along its larger part.

    By a parabola through three pixels.
    """
    height, width = dx.shape
    is_across = np.abs(dx[rows, columns].astype(np.int32)) >= np.abs(dy[rows, columns].astype(np.int32))

    def strength(step: int) -> npt.NDArray[np.float32]:
        at = (
            np.clip(np.where(is_across, rows, rows + step), 0, height - 1),
            np.clip(np.where(is_across, columns + step, columns), 0, width - 1),
        )
        return np.hypot(dx[at].astype(np.float32), dy[at].astype(np.float32))

    before, here, after = strength(-1), strength(0), strength(1)
    curve = 2.0 * here - before - after
    shift = np.clip(np.where(curve > 0, 0.5 * (after - before) / np.maximum(curve, 1e-6), 0.0), -0.5, 0.5)
    places = np.stack([rows + np.where(is_across, 0.0, shift), columns + np.where(is_across, shift, 0.0)], axis=1)
    return places.astype(np.float32)


def _nearest_into(
    nearest: npt.NDArray[np.float32],
    rows: npt.NDArray[np.intp],
    columns: npt.NDArray[np.intp],
    places: npt.NDArray[np.float32],
) -> None:
    """For every pixel (H, W, 2) the place (N, 2) of the nearest of some pixels (N,)."""
    if not len(rows):
        return
    is_far = np.ones(nearest.shape[:2], dtype=np.uint8)
    is_far[rows, columns] = 0
    found = cv2.distanceTransformWithLabels(is_far, cv2.DIST_L2, 3, labelType=cv2.DIST_LABEL_PIXEL)
    labels = found[1].astype(np.int32, copy=False)
    where = np.zeros((int(labels[rows, columns].max()) + 1, 2), dtype=np.float32)
    where[labels[rows, columns]] = places
    # Both numbers of a place are copied as one of 8 bytes.
    np.take(where.view(np.float64)[:, 0], labels, mode="clip", out=nearest.view(np.float64)[:, :, 0])
