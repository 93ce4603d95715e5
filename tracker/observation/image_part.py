"""A part of a colour image as an ideal lens shows it."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera

SMALLEST = 16
"""A part with fewer rows or columns shows nothing of a hand, px."""


@dataclass(frozen=True)
class Window:
    """Which part of an ideal lens's image.

    Attributes:
        camera: Whose.
        low: (2,) first column and row, px.
        width, height: px.
    """

    camera: Camera
    low: npt.NDArray[np.int64]
    width: int
    height: int

    @property
    def K(self) -> npt.NDArray[np.float64]:
        """(3, 3) px; pixel (0, 0) is the part's first."""
        K = self.camera.K.copy()
        K[:2, 2] -= self.low
        return K

    def cut(self, image: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint8]:
        """The part (height, width, ...) of an image (H, W, ...) as recorded."""
        if self.camera.distortion.size:
            size = (self.width, self.height)
            maps = cv2.initUndistortRectifyMap(self.camera.K, self.camera.distortion, None, self.K, size, cv2.CV_16SC2)
            return np.asarray(cv2.remap(image, maps[0], maps[1], cv2.INTER_LINEAR), dtype=np.uint8)
        column, row = self.low
        return image[row : row + self.height, column : column + self.width]


def frame_points(camera: Camera, points: npt.NDArray[np.float64], margin: float) -> Window | None:
    """The part around points (N, 2), px of an ideal lens, with a margin, px; None where they are out of sight."""
    points = points[np.isfinite(points).all(axis=1)]
    if not len(points):
        return None
    low = np.maximum(np.floor(points.min(axis=0) - margin), 0).astype(np.int64)
    high = np.minimum(np.ceil(points.max(axis=0) + margin) + 1, (camera.width, camera.height)).astype(np.int64)
    width, height = (high - low).tolist()
    if width < SMALLEST or height < SMALLEST:
        return None
    return Window(camera, low, width, height)
