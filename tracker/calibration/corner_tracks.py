"""Where a camera saw each corner at any moment: between frames, a curve through the frames around it."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from tracker.calibration.sightings import Sightings

Array = npt.NDArray[np.float64]

SAME_MOMENT = 1e-6
"""Of a frame: a moment so near to a frame is that frame."""


def find_corners_at(sightings: Sightings, times: Array, frozen: bool = False) -> tuple[Array, Array]:
    """Where the corners were, and how fast they moved.

    Between two successive frames a corner goes along Catmull and Rom's cubic, whose slopes come from the frames around
    them; where one of those is missing, from the two alone. A corner that one of the two frames lacks is not known
    there, except at the frame itself.

    Args:
        sightings: Of one camera.
        times: (T,) s in this camera's own time.
        frozen: Take the frame nearest to each moment as it is.

    Returns:
        Pixels (T, N, 2), NaN where not known, and velocities (T, N, 2), px/s, 0 where not known.
    """
    period = 1.0 / sightings.fps
    if frozen:
        place = _find_nearest(sightings.times, times)
        is_near = np.abs(sightings.times[place] - times) < 0.55 * period
        pixels = _take(sightings, np.where(is_near, place, -1))
        return pixels, np.zeros_like(pixels)
    before = np.clip(np.searchsorted(sightings.times, times + SAME_MOMENT * period, side="right") - 1, 0, None)
    is_in = (times >= sightings.times[0] - SAME_MOMENT * period) & (times <= sightings.times[-1] + SAME_MOMENT * period)
    last = len(sightings.times) - 1
    numbers = [np.where(is_in, np.clip(before + step, -1, last + 1), -1) for step in (-1, 0, 1, 2)]
    corners = [_take(sightings, np.where(number > last, -1, number)) for number in numbers]
    moments = [sightings.times[np.clip(number, 0, last)] for number in numbers]
    has_gap = [moments[k + 1] - moments[k] > 1.6 * period for k in range(3)]
    gap = np.where(moments[2] > moments[1], moments[2] - moments[1], period)[:, None, None]
    share = np.clip((times - moments[1])[:, None, None] / gap, 0.0, 1.0)
    first, second = corners[1], np.where(has_gap[1][:, None, None], np.nan, corners[2])
    chord = (second - first) / gap
    early = _slope(corners[0], second, moments[2] - moments[0], has_gap[0], chord)
    late = _slope(first, corners[3], moments[3] - moments[1], has_gap[2], chord)
    a, b = share, 1.0 - share
    pixels = b * b * (1 + 2 * a) * first + a * a * (1 + 2 * b) * second + gap * a * b * (b * early - a * late)
    speed = 6 * a * b * chord + b * (b - 2 * a) * early + a * (a - 2 * b) * late
    is_frame = (times - moments[1] < SAME_MOMENT * period) & is_in
    here = is_frame[:, None, None]
    back = np.where(has_gap[0][:, None, None], np.nan, (first - corners[0]) / period)
    alone = np.where(np.isfinite(early), early, back)
    pixels = np.where(here, first, pixels)
    speed = np.where(here, alone, speed)
    return pixels, np.where(np.isfinite(speed), speed, 0.0)


def _slope(before: Array, after: Array, span: Array, has_gap: npt.NDArray[np.bool_], chord: Array) -> Array:
    """Through the neighbours where both are there, else along the chord; px/s."""
    wide = (after - before) / np.where(span > 0, span, 1.0)[:, None, None]
    return np.where(np.isfinite(wide) & ~has_gap[:, None, None] & (span > 0)[:, None, None], wide, chord)


def _take(sightings: Sightings, numbers: npt.NDArray[np.int64]) -> Array:
    """Corners (T, N, 2) of frames by their numbers (T,); NaN where the board was not found, and for -1."""
    if len(sightings.frames) == 0:
        return np.full((len(numbers), *sightings.corners.shape[1:]), np.nan)
    place = np.clip(np.searchsorted(sightings.frames, numbers), 0, len(sightings.frames) - 1)
    is_there = sightings.frames[place] == numbers
    return np.where(is_there[:, None, None], sightings.corners[place], np.nan)


def _find_nearest(times: Array, wanted: Array) -> npt.NDArray[np.int64]:
    after = np.clip(np.searchsorted(times, wanted), 1, max(len(times) - 1, 1))
    if len(times) == 1:
        return np.zeros(len(wanted), dtype=np.int64)
    return np.where(wanted - times[after - 1] < times[after] - wanted, after - 1, after)
