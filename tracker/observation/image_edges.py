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
    is_edge = cv2.Canny(dx, dy, WEAK, STRONG) > 0
    places = _refine(np.hypot(dx.astype(np.float32), dy.astype(np.float32)), dx, dy)
    angle = np.arctan2(dy.astype(np.float32), dx.astype(np.float32)) % np.pi
    bins = (angle * (DIRECTIONS / np.pi)).astype(np.int8) % DIRECTIONS
    nearest = np.full((DIRECTIONS, height, width, 2), np.nan, dtype=np.float32)
    for direction in range(DIRECTIONS):
        beside = (bins - direction) % DIRECTIONS
        _nearest_into(nearest[direction], is_edge & ((beside <= 1) | (beside == DIRECTIONS - 1)), places)
    return ImageEdges(window.K, camera.T_world_camera, nearest)


def _refine(
    strength: npt.NDArray[np.float32], dx: npt.NDArray[np.int16], dy: npt.NDArray[np.int16]
) -> npt.NDArray[np.float32]:
    """(H, W, 2) row and column where the gradient is strongest, along its larger part, by a parabola through three."""
    height, width = strength.shape
    rows, columns = np.indices((height, width), dtype=np.float32)
    padded = np.pad(strength, 1, mode="edge")
    is_across = np.abs(dx.astype(np.int32)) >= np.abs(dy.astype(np.int32))
    before = np.where(is_across, padded[1:-1, :-2], padded[:-2, 1:-1])
    after = np.where(is_across, padded[1:-1, 2:], padded[2:, 1:-1])
    curve = 2.0 * strength - before - after
    shift = np.clip(np.where(curve > 0, 0.5 * (after - before) / np.maximum(curve, 1e-6), 0.0), -0.5, 0.5)
    return np.stack([rows + np.where(is_across, 0.0, shift), columns + np.where(is_across, shift, 0.0)], axis=2)


def _nearest_into(
    nearest: npt.NDArray[np.float32], chosen: npt.NDArray[np.bool_], places: npt.NDArray[np.float32]
) -> None:
    """Place (H, W, 2) of the nearest chosen pixel (H, W)."""
    if not chosen.any():
        return
    found = cv2.distanceTransformWithLabels((~chosen).astype(np.uint8), cv2.DIST_L2, 3, labelType=cv2.DIST_LABEL_PIXEL)
    labels = found[1].astype(np.int64)
    where = np.zeros((int(labels.max()) + 1, 2), dtype=np.float32)
    where[labels[chosen]] = places[chosen]
    nearest[:] = where[labels]
