"""How well calibrated cameras agree with what they saw, also at moments they were not fitted to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from tracker.calibration.arrangement import Arrangement, Corners
from tracker.calibration.board import Board
from tracker.calibration.board_places import find_board_places
from tracker.calibration.bundle import Freedom, adjust
from tracker.calibration.camera_calibration import BoardResiduals
from tracker.calibration.moments import read_corners
from tracker.calibration.sightings import Sightings

Array = npt.NDArray[np.float64]
Mask = npt.NDArray[np.bool_]


def judge(
    board: Board,
    sightings: Sequence[Sightings],
    moments: Array,
    cameras: Arrangement,
    offsets: Array,
    is_told: Mask,
    is_left_out: Mask,
) -> tuple[BoardResiduals, BoardResiduals, Array]:
    """How well cameras agree with what they saw.

    Args:
        board: The board.
        sightings: Of C cameras.
        moments: (B,) s in the first camera's time.
        cameras: As fitted; they stay as they are.
        offsets: (C,) s.
        is_told: (C,) whether a camera's offset is known.
        is_left_out: (B,) moments that the cameras were not fitted to.

    Returns:
        Residuals with the cameras fixed and each board fitted to all cameras; at what was left out, the same with the
            board fitted to the other cameras alone; and the boards' places (B, 4, 4), NaN where not known.
    """
    corners = read_corners(board, sightings, moments, offsets, is_told)
    still = replace(cameras, offsets=np.zeros(len(sightings)))
    fixed = Freedom(cameras=False, lenses=False, offsets=False)

    def fit(used: Corners) -> Arrangement:
        places = find_board_places(board, still, used, len(moments))
        is_placed = np.isfinite(places[:, 0, 0])
        used = used.choose(is_placed[used.moment])
        found = adjust(replace(still, T_world_board=np.where(is_placed[:, None, None], places, np.eye(4))), used, fixed)
        return replace(found, T_world_board=np.where(is_placed[:, None, None], found.T_world_board, np.nan))

    def measure(fitted: Arrangement, seen: Corners) -> BoardResiduals:
        distance = np.linalg.norm(fitted.residuals(seen), axis=1)
        is_known = np.isfinite(distance)
        return BoardResiduals(seen.camera[is_known], seen.moment[is_known], distance[is_known], seen.pixels[is_known])

    together = fit(corners)
    others = []
    for number in range(len(sightings)):
        own = corners.camera == number
        has_own = np.isin(corners.moment, corners.moment[own]) & is_left_out[corners.moment]
        others.append(measure(fit(corners.choose(has_own & ~own)), corners.choose(has_own & own)))
    parts = [
        np.concatenate([getattr(other, name) for other in others]) for name in ("camera", "moment", "px", "pixels")
    ]
    return measure(together, corners), BoardResiduals(*parts), together.T_world_board
