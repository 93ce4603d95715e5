"""The moments a calibration looks at: which are used, which are left out to judge it, and what was seen at them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from tracker.calibration.arrangement import Corners
from tracker.calibration.board import Board
from tracker.calibration.corner_detector import MIN_CORNERS
from tracker.calibration.corner_tracks import find_corners_at
from tracker.calibration.sightings import Sightings

Array = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]
Mask = npt.NDArray[np.bool_]

BLOCK_S = 1.0
"""Frames are left out by whole seconds: the board is nearly where it was a frame before."""

CELLS = 8
"""Along each side of a picture, to count what was covered."""


def list_moments(sightings: Sequence[Sightings], offsets: Array) -> Array:
    """(T,) s in the first camera's time: its frames, and as many more as the other cameras' videos reach beyond."""
    first = sightings[0]
    period = 1.0 / first.fps
    begin = min(float(seen.times[0] - offset) for seen, offset in zip(sightings, offsets, strict=True))
    end = max(float(seen.times[-1] - offset) for seen, offset in zip(sightings, offsets, strict=True))
    before = first.times[0] - period * np.arange(int((first.times[0] - begin) / period + 0.5), 0, -1)
    after = first.times[-1] + period * np.arange(1, int((end - first.times[-1]) / period + 0.5) + 1)
    return np.concatenate([before, first.times, after])


def read_corners(
    board: Board,
    sightings: Sequence[Sightings],
    moments: Array,
    offsets: Array,
    moving: Mask,
) -> Corners:
    """All corners that the cameras saw at some moments.

    Args:
        board: The board.
        sightings: Of C cameras.
        moments: (B,) s in the first camera's time.
        offsets: (C,) s to add to a moment to get a camera's own time.
        moving: (C,) whether a camera's offset is known or looked for; another one's frames are taken as they are.
    """
    parts = []
    for number, (seen, offset) in enumerate(zip(sightings, offsets, strict=True)):
        pixels, velocity = find_corners_at(seen, moments + offset, frozen=not moving[number])
        is_seen = np.isfinite(pixels[..., 0])
        is_seen &= (is_seen.sum(axis=1) >= MIN_CORNERS)[:, None]
        moment, corner = np.nonzero(is_seen)
        parts.append((np.full(len(moment), number), moment, board.corners[corner], pixels[is_seen], velocity[is_seen]))
    return Corners(*(np.concatenate(part) for part in zip(*parts, strict=True)))


def count_cameras(corners: Corners, moments: int, cameras: int) -> Integers:
    """(B,) how many cameras saw the board at each moment."""
    seen = np.zeros((moments, cameras), dtype=bool)
    seen[corners.moment, corners.camera] = True
    return seen.sum(axis=1)


def leave_out(moments: Array, share: float) -> Mask:
    """(T,) which moments are left out: whole seconds, spread evenly over the time."""
    if share <= 0.0 or len(moments) == 0:
        return np.zeros(len(moments), dtype=bool)
    every = max(2, round(1.0 / share))
    length = min(BLOCK_S, float(np.ptp(moments)) / (2 * every) + 1e-9)
    block = np.floor((moments - moments[0]) / length).astype(int)
    return block % every == every // 2


def choose_moments(corners: Corners, sizes: Array, allowed: Mask, most: int) -> Integers:
    """At most `most` moments, those that fill what the pictures lack so far; ones that several cameras share first.

    Args:
        corners: Of all moments.
        sizes: (C, 2) px, of the pictures.
        allowed: (B,) moments to choose from.
        most: How many.
    """
    cameras = len(sizes)
    cell = np.clip((corners.pixels / sizes[corners.camera] * CELLS).astype(int), 0, CELLS - 1)
    place = (corners.camera * CELLS + cell[:, 1]) * CELLS + cell[:, 0]
    counts = np.zeros((len(allowed), cameras * CELLS * CELLS))
    np.add.at(counts, (corners.moment, place), 1.0)
    shared = count_cameras(corners, len(allowed), cameras)
    weight = np.where(allowed & (shared > 0), np.where(shared > 1, shared, 0.25), 0.0)
    covered = np.zeros(counts.shape[1])
    chosen: list[int] = []
    while len(chosen) < most and weight.any():
        gain = weight * (counts @ (1.0 / (1.0 + covered)))
        best = int(np.argmax(gain))
        chosen.append(best)
        covered += counts[best]
        weight[best] = 0.0
    return np.array(sorted(chosen), dtype=np.int64)
