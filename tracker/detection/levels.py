"""An image at the scales in which a hand looks the same size whatever its distance."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt
from numba import njit

from tracker.detection.channels import compute_channels
from tracker.detection.patch_image import PatchImage

PATCH = 16
"""Side of a patch, px of a level, [T16] §3.2.5."""

PAD = PATCH // 2
"""Empty px around a level, so that a patch may be centred at its border."""

LEVEL_RATIO = 1.25
"""Distance of a level from that of the one before."""

DEPTH_STEP = 0.002
"""Depth between two grey levels, m."""

MIN_SPACING = 0.5
"""Where a level's pixel is narrower than this many px of the image, a fingertip is too small to be found."""

NOTHING = 255
"""Grey level where there is no depth: farther than everything."""

FAR = 250
"""Largest grey level of a depth."""


@dataclass(frozen=True)
class Level:
    """The image sampled so that a pixel is as wide as the forest wants at one depth.

    Attributes:
        depth: Where that is exact, m.
        spacing: px of the image between two px of the level.
        channels: (H + 2 PAD, W + 2 PAD, CHANNELS) uint8.
        centers: (N, 2) int32 row and column, px of the level without its padding, where patches are centred: pixels of
            the mask to whose depth no other level is nearer.
        depths: (N,) float32 their depths, m.
        depth_image: (H, W) float32 mean depths, m; 0 where there are none.
    """

    depth: float
    spacing: float
    channels: npt.NDArray[np.uint8]
    centers: npt.NDArray[np.int32]
    depths: npt.NDArray[np.float32]
    depth_image: npt.NDArray[np.float32]

    def to_level(self, pixels: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        """(N, 2) column and row of the image to column and row of the level."""
        return (pixels + 0.5) / self.spacing - 0.5


def build_levels(image: PatchImage, kind: str, pixel_size: float, stride: int = 1, scale: float = 1.0) -> list[Level]:
    """Levels that together cover the mask, nearest first; what is too far away for a fingertip to show is left out.

    Args:
        image: Where to look.
        kind: "depth" or "color".
        pixel_size: Width of a level's pixel, m.
        stride: A patch at every so many px of a level in each direction.
        scale: Look for hands so many times as large.
    """
    assert kind in ("depth", "color")
    known = image.depth[image.mask & (image.depth > 0.0)]
    if known.size == 0:
        return []
    near, far = np.percentile(known[:: max(1, known.size // 4096)], (1.0, 99.0))
    count = max(1, int(np.ceil(np.log(far / near) / np.log(LEVEL_RATIO))))
    ratio = (far / near) ** (1.0 / count)
    levels = []
    for number in range(count):
        # Each level serves the depths from one border to the next; the first and the last also those beyond.
        lower = near * ratio**number if number > 0 else 0.0
        upper = near * ratio ** (number + 1) if number < count - 1 else np.inf
        depth = float(near * ratio ** (number + 0.5))
        spacing = scale * pixel_size * image.focal / depth
        if spacing < MIN_SPACING:
            break
        levels.append(_build_level(image, kind, depth, spacing, float(lower), float(upper), stride))
    return levels


def _build_level(
    image: PatchImage, kind: str, depth: float, spacing: float, lower: float, upper: float, stride: int
) -> Level:
    height, width = (max(1, int(np.ceil(length / spacing))) for length in image.depth.shape)
    depth_image = np.zeros((height, width), dtype=np.float32)
    is_center = np.zeros((height, width), dtype=np.bool_)
    _resample_into(depth_image, is_center, image.depth, image.mask, spacing)
    is_center &= (depth_image >= lower) & (depth_image < upper)
    if stride > 1:
        kept = np.zeros_like(is_center)
        kept[::stride, ::stride] = is_center[::stride, ::stride]
        is_center = kept
    if kind == "depth":
        steps = np.clip((depth_image - np.float32(depth)) * np.float32(1.0 / DEPTH_STEP) + 125.5, 0.0, FAR)
        grey = np.where(depth_image > 0.0, steps.astype(np.uint8), np.uint8(NOTHING))
        grey = np.pad(grey, PAD, constant_values=NOTHING)
    else:
        assert image.color is not None, "a forest that looks at colour needs a colour image"
        intensity = cv2.cvtColor(np.ascontiguousarray(image.color), cv2.COLOR_RGB2GRAY).astype(np.uint8)
        grey = np.pad(_resample_intensity(intensity, height, width, spacing), PAD, mode="edge")
    centers = np.argwhere(is_center).astype(np.int32)
    depths = depth_image[is_center]
    return Level(depth, spacing, compute_channels(np.ascontiguousarray(grey)), centers, depths, depth_image)


def _resample_intensity(
    intensity: npt.NDArray[np.uint8], height: int, width: int, spacing: float
) -> npt.NDArray[np.uint8]:
    """(height, width) of an image, smoothed over a pixel of the level where that is larger than the image's."""
    if spacing > 1.2:
        intensity = cv2.GaussianBlur(intensity, (0, 0), 0.4 * spacing).astype(np.uint8)
    columns = ((np.arange(width, dtype=np.float32) + 0.5) * spacing - 0.5)[None].repeat(height, axis=0)
    rows = ((np.arange(height, dtype=np.float32) + 0.5) * spacing - 0.5)[:, None].repeat(width, axis=1)
    sampled = cv2.remap(
        intensity,
        columns.astype(np.float32),
        rows.astype(np.float32),
        cv2.INTER_LINEAR,
        borderMode=cv2.BORDER_REPLICATE,
    )
    return sampled.astype(np.uint8)


@njit(cache=True, nogil=True)
def _resample_into(depth_image, is_center, depth, mask, spacing):
    """Mean depth of the pixels that a level's pixel covers, where half of them have one; whether half are masked."""
    height, width = depth.shape
    for i in range(len(depth_image)):
        top, bottom = int(np.ceil(i * spacing - 0.5)), int(np.ceil((i + 1) * spacing - 0.5))
        if bottom <= top:
            top = int(np.rint((i + 0.5) * spacing - 0.5))
            bottom = top + 1
        top, bottom = max(0, min(top, height - 1)), min(bottom, height)
        for j in range(depth_image.shape[1]):
            left, right = int(np.ceil(j * spacing - 0.5)), int(np.ceil((j + 1) * spacing - 0.5))
            if right <= left:
                left = int(np.rint((j + 0.5) * spacing - 0.5))
                right = left + 1
            left, right = max(0, min(left, width - 1)), min(right, width)
            total, count, masked = 0.0, 0, 0
            for r in range(top, bottom):
                for c in range(left, right):
                    if depth[r, c] > 0.0:
                        total += depth[r, c]
                        count += 1
                        if mask[r, c]:
                            masked += 1
            if count > 0 and 2 * count >= (bottom - top) * (right - left):
                depth_image[i, j] = total / count
                is_center[i, j] = 2 * masked >= count
