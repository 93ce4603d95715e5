"""The turned square of an image that a network looks at."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

NEAR = 0.15
"""Share of its size that the square of a hand and that of its palm may be apart."""


@dataclass(frozen=True)
class Square:
    """A square of an image; it may go beyond the image's border.

    Attributes:
        center: (2,) column and row, px.
        size: Of a side, px.
        angle: rad; turned by it, the image's up points from the wrist to the fingers.
    """

    center: Array
    size: float
    angle: float = 0.0

    def is_near(self, other: Square) -> bool:
        """Whether two squares are around one hand: their centers are apart by little of their size."""
        return float(np.linalg.norm(self.center - other.center)) < NEAR * min(self.size, other.size)

    @classmethod
    def around(cls, points: Array, angle: float, shift: float, scale: float) -> Square:
        """The square around points (N, 2), px: their box along the turned axes, moved and enlarged.

        Args:
            points: What it is around.
            angle: Of the square, rad.
            shift: Up by this share of the box's height.
            scale: Times the longer side of the box.
        """
        turn = _turn(angle)
        along = points @ turn
        low, high = along.min(axis=0), along.max(axis=0)
        width, height = high - low
        center = 0.5 * (low + high) - (0.0, shift * height)
        return cls(turn @ center, scale * float(max(width, height)), angle)

    def cut(self, image: npt.NDArray[np.uint8], pixels: int) -> npt.NDArray[np.float32]:
        """(1, 3, pixels, pixels) the square of an image (H, W, 3), 0 to 1; black beyond the border."""
        wanted = np.array([[0.0, 0.0], [pixels, 0.0], [0.0, pixels]]) - 0.5
        to_crop = cv2.getAffineTransform(self.to_image(wanted, pixels).astype(np.float32), wanted.astype(np.float32))
        crop = cv2.warpAffine(image, to_crop, (pixels, pixels), flags=cv2.INTER_LINEAR, borderMode=cv2.BORDER_CONSTANT)
        return np.asarray(crop.transpose(2, 0, 1)[None], dtype=np.float32) / np.float32(255.0)

    def to_image(self, points: Array, pixels: int) -> Array:
        """(N, 2) px of the image, of points (N, 2) px of a crop with this many pixels a side."""
        return self.center + (points + 0.5 - 0.5 * pixels) * (self.size / pixels) @ _turn(self.angle).T

    def turn_back(self, points: Array) -> Array:
        """(N, 3) points whose x and y are along the square, along the image's axes."""
        turned = points.copy()
        turned[:, :2] = points[:, :2] @ _turn(self.angle).T
        return turned


def angle_of(wrist: Array, fingers: Array) -> float:
    """rad, from the image's up to the direction from a wrist (2,) to the base of the fingers (2,), px."""
    right, down = fingers - wrist
    return float(np.arctan2(right, -down))


def _turn(angle: float) -> Array:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s], [s, c]])
