"""Patches to learn from: those around fingertips, and others."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.detection.channels import CHANNELS
from tracker.detection.levels import build_levels
from tracker.detection.patch_image import PatchImage

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class PatchOptions:
    """Which patches of an annotated image are learnt from.

    Attributes:
        kind: "depth" or "color".
        pixel_size: Width of a pixel of a patch, m.
        positive_reach: Patches centred at most so far from a fingertip, across the image, belong to it, m.
        negative_reach: Patches centred at least so far from every visible fingertip don't, m.
        depth_reach: And at most so much nearer or farther than it, m.
        hidden_reach: Patches so close to an occluded fingertip are left out, m.
        per_image: Patches of each sort from an image, at most.
        scale_spread: Standard deviation of the logarithm by which each image is taken larger or smaller.
    """

    kind: str = "depth"
    pixel_size: float = 0.003
    positive_reach: float = 0.028
    negative_reach: float = 0.036
    depth_reach: float = 0.035
    hidden_reach: float = 0.020
    per_image: int = 60
    scale_spread: float = 0.08


@dataclass(frozen=True)
class Patches:
    """Patches as places in images of channels, which are kept whole.

    Attributes:
        channels: (B,) uint8, all images behind each other.
        corners: (N,) int64 where the first pixel of a patch stands in `channels`.
        widths: (N,) int32 px in a row of its image.
        is_fingertip: (N,) bool.
        offsets: (N, 3) float32 column, row and depth from its centre to the fingertip, px of a patch; 0 for others.
    """

    channels: npt.NDArray[np.uint8]
    corners: npt.NDArray[np.int64]
    widths: npt.NDArray[np.int32]
    is_fingertip: npt.NDArray[np.bool_]
    offsets: npt.NDArray[np.float32]

    def __len__(self) -> int:
        return len(self.corners)


def join_patches(parts: list[Patches]) -> Patches:
    """All patches of several collections."""
    assert parts
    starts = np.cumsum([0, *(part.channels.size for part in parts[:-1])])
    return Patches(
        np.concatenate([part.channels for part in parts]),
        np.concatenate([part.corners + start for part, start in zip(parts, starts, strict=True)]),
        np.concatenate([part.widths for part in parts]),
        np.concatenate([part.is_fingertip for part in parts]),
        np.concatenate([part.offsets for part in parts]),
    )


def sample_patches(
    image: PatchImage,
    tips: Array,
    is_visible: npt.NDArray[np.bool_],
    options: PatchOptions,
    rng: np.random.Generator,
) -> Patches:
    """Patches of one image.

    Args:
        image: Depth, mask, colour.
        tips: (T, 2) column and row of the fingertips in the image, px.
        is_visible: (T,) whether a fingertip is seen; the others are occluded.
        options: Which patches.
        rng: Source of chance.
    """
    assert tips.shape == (len(is_visible), 2)
    scale = float(np.exp(rng.normal(0.0, options.scale_spread)))
    gathered: list[tuple[npt.NDArray, npt.NDArray, npt.NDArray, int, int]] = []
    blobs, start = [], 0
    for level in build_levels(image, options.kind, options.pixel_size, 1, scale):
        if len(level.centers) == 0:
            continue
        on_level = level.to_level(tips)
        tip_depths = _depths_at(level.depth_image, on_level)
        seen = is_visible & (tip_depths > 0.0)
        # Offsets in px of a patch that is centred at the patch's own depth.
        zoom = (level.depths / level.depth)[:, None]
        across = (on_level[None] - level.centers[:, None, ::-1]) * zoom[:, :, None]
        distance = np.linalg.norm(across, axis=2) * options.pixel_size
        behind = np.abs(level.depths[:, None] - tip_depths[None])
        own = np.where(seen[None] & (behind < options.depth_reach), distance, np.inf)
        nearest = np.argmin(own, axis=1) if len(tips) else np.zeros(len(level.centers), dtype=np.int64)
        reach = own[np.arange(len(own)), nearest] if len(tips) else np.full(len(own), np.inf)
        positive = reach < options.positive_reach
        blocked = (np.where(seen[None], own, np.inf) < options.negative_reach).any(axis=1)
        blocked |= (np.where(seen[None], np.inf, distance) < options.hidden_reach).any(axis=1)
        negative = ~positive & ~blocked
        width = level.channels.shape[1]
        offsets = np.zeros((len(level.centers), 3), dtype=np.float32)
        chosen = np.flatnonzero(positive)
        offsets[chosen, :2] = across[chosen, nearest[chosen]]
        offsets[chosen, 2] = (tip_depths[nearest[chosen]] - level.depths[chosen]) / options.pixel_size
        corners = start + (level.centers[:, 0].astype(np.int64) * width + level.centers[:, 1]) * CHANNELS
        for places, is_tip in ((chosen, True), (np.flatnonzero(negative), False)):
            gathered.append((corners[places], offsets[places], np.full(len(places), is_tip), width, len(places)))
        blobs.append(level.channels.reshape(-1))
        start += level.channels.size
    if not gathered:
        return _no_patches()
    corners = np.concatenate([item[0] for item in gathered])
    offsets = np.concatenate([item[1] for item in gathered])
    is_fingertip = np.concatenate([item[2] for item in gathered])
    widths = np.concatenate([np.full(item[4], item[3], dtype=np.int32) for item in gathered])
    kept = np.sort(
        np.concatenate([_some(np.flatnonzero(is_fingertip == sort), options.per_image, rng) for sort in (True, False)])
    )
    return Patches(np.concatenate(blobs), corners[kept], widths[kept], is_fingertip[kept], offsets[kept])


def _no_patches() -> Patches:
    nothing = np.zeros(0, dtype=np.uint8)
    return Patches(
        nothing,
        np.zeros(0, dtype=np.int64),
        np.zeros(0, dtype=np.int32),
        np.zeros(0, dtype=np.bool_),
        np.zeros((0, 3), dtype=np.float32),
    )


def _some(places: npt.NDArray[np.int64], count: int, rng: np.random.Generator) -> npt.NDArray[np.int64]:
    return places if len(places) <= count else rng.choice(places, count, replace=False)


def _depths_at(depth_image: npt.NDArray[np.float32], places: Array, reach: int = 2) -> Array:
    """(T,) depth at the nearest pixel that has one, at most `reach` px away; 0 if there is none."""
    depths = np.zeros(len(places))
    for index, (x, y) in enumerate(places):
        if not (np.isfinite(x) and np.isfinite(y)):
            continue
        column, row = int(np.rint(np.clip(x, -99, 1e6))), int(np.rint(np.clip(y, -99, 1e6)))
        top, left = max(0, row - reach), max(0, column - reach)
        window = depth_image[top : max(top, row + reach + 1), left : max(left, column + reach + 1)]
        rows, columns = np.nonzero(window > 0.0)
        if len(rows):
            best = np.argmin((rows + top - y) ** 2 + (columns + left - x) ** 2)
            depths[index] = window[rows[best], columns[best]]
    return depths
