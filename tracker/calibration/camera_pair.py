"""Two cameras that saw the same board: where one is in the other's frame, and how far their videos are out of step.

The board's poses in one camera, moved by one rigid motion, are those in the other; that holds at the true time offset
and, while the board moves, at no other. So every offset within reach is tried, and the one where the poses agree best
is taken.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.calibration.board import Board
from tracker.calibration.board_pose import measure_transfer
from tracker.calibration.lens import Lens
from tracker.calibration.sightings import Sightings
from tracker.capture.calibration import nearest_rotation

Array = npt.NDArray[np.float64]

MOST_SHARED = 40
"""Boards of a pair that are compared; the motion between two cameras has six unknowns."""

MIN_SHARED = 3
"""Moments at which both cameras see the board."""
TELLING = 1.5
"""Times the best offset's disagreement, that the usual offset must have: else the board hardly moved, and every
offset is as good."""

AS_GOOD = 1.1
"""Times the best offset's disagreement, up to which an offset nearer to none is preferred."""


@dataclass(frozen=True, eq=False)
class SeenBoards:
    """One camera's sightings with the board's pose in each.

    Attributes:
        sightings: As found.
        lens: The camera's.
        poses: (S, 4, 4) T_camera_board, m; NaN where it is not known.
    """

    sightings: Sightings
    lens: Lens
    poses: Array


@dataclass(frozen=True, eq=False)
class CameraPair:
    """How the second camera relates to the first.

    Attributes:
        first: Number of a camera.
        second: Number of another.
        T_first_second: (4, 4) m.
        offset_s: What must be added to a time of the first to get the second's time of the same moment.
        shared: Boards that both saw.
        error_px: How far the second's boards are from the first's, in the first's picture, at the median.
        is_telling: The offset is clearly better than others.
    """

    first: int
    second: int
    T_first_second: Array
    offset_s: float
    shared: int
    error_px: float
    is_telling: bool


def relate_cameras(
    numbers: tuple[int, int], board: Board, first: SeenBoards, second: SeenBoards, max_offset_s: float = 0.0
) -> CameraPair | None:
    """The pair at the best offset of at most `max_offset_s`; none when they share fewer than `MIN_SHARED` boards."""
    period = max(1.0 / first.sightings.fps, 1.0 / second.sightings.fps)
    reach = int(max_offset_s / period)
    offsets = period * np.array(sorted(range(-reach, reach + 1), key=abs), dtype=np.float64)
    matches = [_match(first.sightings, second.sightings, offset, period) for offset in offsets]
    most = max(len(ours) for ours, _ in matches)
    least = max(MIN_SHARED, min(2 * MIN_SHARED + 2, most), most // 4)
    found: list[CameraPair] = []
    for offset, (ours, theirs) in zip(offsets, matches, strict=True):
        if len(ours) < least:
            continue
        step = np.unique(np.linspace(0, len(ours) - 1, MOST_SHARED).astype(int))
        T, error = _relate(board, first.lens.K, first.poses[ours[step]], second.poses[theirs[step]])
        if np.isfinite(error):
            found.append(CameraPair(*numbers, T, float(offset), len(ours), error, False))
    if not found:
        return None
    errors = np.array([pair.error_px for pair in found])
    best = int(np.argmax(errors <= AS_GOOD * errors.min()))
    chosen = found[best]
    is_telling = len(found) > 1 and float(np.median(errors)) > TELLING * errors.min()
    if len(found) > 1 and not is_telling:
        chosen = found[0]
    return CameraPair(*numbers, chosen.T_first_second, chosen.offset_s, chosen.shared, chosen.error_px, is_telling)


def _match(
    first: Sightings, second: Sightings, offset: float, period: float
) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """Places of the sightings of both that show one moment, to half a frame."""
    if not len(second.frames):
        return np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int64)
    wanted, there = first.seen_at + offset, second.seen_at
    after = np.clip(np.searchsorted(there, wanted), 0, len(there) - 1)
    before = np.clip(after - 1, 0, None)
    nearest = np.where(np.abs(there[before] - wanted) < np.abs(there[after] - wanted), before, after)
    ours = np.flatnonzero(np.abs(there[nearest] - wanted) < 0.501 * period)
    return ours, nearest[ours]


def _relate(board: Board, K: Array, ours: Array, theirs: Array) -> tuple[Array, float]:
    """The motion (4, 4) that most pairs of poses (S, 4, 4) agree on, and their disagreement at the median, px."""
    is_known = np.isfinite(ours[:, 0, 0]) & np.isfinite(theirs[:, 0, 0])
    ours, theirs = ours[is_known], theirs[is_known]
    if len(ours) < MIN_SHARED:
        return np.eye(4), np.inf
    motions = ours @ np.linalg.inv(theirs)
    distance_m = float(np.median(np.linalg.norm(theirs[:, :3, 3], axis=1)))
    flat = np.concatenate([distance_m * motions[:, :3, :3].reshape(-1, 9), motions[:, :3, 3]], axis=1)
    flat -= flat.mean(axis=0)
    squares = (flat**2).sum(axis=1)
    apart = np.sqrt(np.maximum(squares[:, None] + squares - 2.0 * flat @ flat.T, 0.0))
    middle = int(np.argmin(np.median(apart, axis=1)))
    near = apart[middle] <= 2.0 * np.median(apart[middle]) + 1e-9
    T = np.eye(4)
    T[:3, :3] = nearest_rotation(motions[near, :3, :3].mean(axis=0))
    T[:3, 3] = motions[near, :3, 3].mean(axis=0)
    return T, float(np.median(measure_transfer(board, K, ours, T @ theirs)))
