"""Images in which there is something to learn: discs that stand out of a plane."""

from __future__ import annotations

import numpy as np

from tracker.detection.patch_image import PatchImage
from tracker.detection.sampling import PatchOptions, join_patches, sample_patches
from tracker.detection.training import ForestOptions

PATCHES = PatchOptions(pixel_size=0.003, per_image=40, scale_spread=0.0)
SMALL = ForestOptions(trees=4, depth=12, min_leaf=10, tests=1000, patches=2000)
FOCAL = 200.0


def disc_image(rng: np.random.Generator, discs: int = 3) -> tuple[PatchImage, np.ndarray]:
    """A plane 0.5 m away with round bumps, 2 cm wide, 2 cm nearer, noise of 1 mm; and their centres (T, 2) px."""
    rows, columns = np.mgrid[:120, :160]
    depth = np.full((120, 160), 0.5)
    centers: list[np.ndarray] = []
    while len(centers) < discs:
        center = rng.uniform([20, 20], [140, 100])
        if all(np.linalg.norm(center - other) > 35 for other in centers):
            centers.append(center)
            depth[np.hypot(columns - center[0], rows - center[1]) < 0.01 * FOCAL / 0.48] = 0.48
    depth += rng.normal(scale=0.001, size=depth.shape)
    return PatchImage(depth.astype(np.float32), np.ones(depth.shape, dtype=bool), FOCAL), np.array(centers)


def disc_patches(count: int = 40, seed: int = 0):
    """Patches of `count` such images."""
    rng = np.random.default_rng(seed)
    parts = []
    for _ in range(count):
        image, centers = disc_image(rng)
        parts.append(sample_patches(image, centers, np.ones(len(centers), dtype=bool), PATCHES, rng))
    return join_patches(parts)
