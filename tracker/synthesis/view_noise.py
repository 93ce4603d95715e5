"""Disturbances of colour views and of what is detected in them, as [T16] §4.4.1 simulates them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class ViewNoise:
    """How views are disturbed; the paper's numbers where it has them.

    Attributes:
        circles: Discs in each image, every other one brighter, the rest darker than what they cover.
        smallest, largest: Of their radii, px.
        contrast: By so many levels of 255; the paper does not say.
        detected: Share of the visible joints that are detected; Fig. 17a varies it and Table 15 does not say.
        false: Share of the detections that are of something else.
        reach: A false detection lies so near to the joint, px.
        sigma: Standard deviation of the others' coordinates, px.
    """

    circles: int = 100
    smallest: float = 10.0
    largest: float = 30.0
    contrast: float = 60.0
    detected: float = 0.7
    false: float = 0.1
    reach: float = 200.0
    sigma: float = 5.0


def disturb_image(
    image: npt.NDArray[np.uint8], noise: ViewNoise, rng: np.random.Generator
) -> tuple[npt.NDArray[np.uint8], npt.NDArray[np.bool_]]:
    """The image (H, W, 3) with discs added and removed, and which pixels (H, W) they cover."""
    height, width = image.shape[:2]
    change = np.zeros((height, width), dtype=np.int16)
    is_covered = np.zeros((height, width), dtype=np.bool_)
    centers = rng.uniform((0.0, 0.0), (width, height), (noise.circles, 2))
    radii = rng.uniform(noise.smallest, noise.largest, noise.circles)
    for number, ((column, row), radius) in enumerate(zip(centers, radii, strict=True)):
        left, top = max(0, int(column - radius)), max(0, int(row - radius))
        inside = slice(top, int(row + radius) + 2), slice(left, int(column + radius) + 2)
        patch = change[inside]
        rows, columns = np.ogrid[top : top + patch.shape[0], left : left + patch.shape[1]]
        disc = (rows - row) ** 2 + (columns - column) ** 2 <= radius**2
        patch[disc] += int(noise.contrast) if number % 2 == 0 else -int(noise.contrast)
        is_covered[inside] |= disc
    return np.clip(image + change[:, :, None], 0, 255).astype(np.uint8), is_covered


def disturb_joints(
    points: Array, is_visible: npt.NDArray[np.bool_], noise: ViewNoise, rng: np.random.Generator
) -> Array:
    """Where a detector with this noise says that joints are, (N, 2) px; NaN where it says nothing.

    Args:
        points: (N, 2) px, where they are.
        is_visible: (N,) the others are never detected.
        noise: Of the detector.
        rng: Where chance comes from; as much is drawn whatever is visible.
    """
    count = len(points)
    is_detected = is_visible & (rng.random(count) < noise.detected)
    is_false = rng.random(count) < noise.false
    near = points + rng.normal(0.0, noise.sigma, (count, 2))
    angle, distance = rng.uniform(0.0, 2.0 * np.pi, count), noise.reach * np.sqrt(rng.random(count))
    far = points + distance[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
    found = np.where(is_false[:, None], far, near)
    found[~is_detected] = np.nan
    return found
