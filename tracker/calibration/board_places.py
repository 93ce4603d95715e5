"""Where the board was at each moment, to begin with: as the camera says whose answer suits all of them best."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from tracker.calibration.arrangement import Arrangement, Corners
from tracker.calibration.board import Board
from tracker.calibration.board_pose import find_board_poses
from tracker.calibration.lens import Lens
from tracker.geometry.se3 import inverse

Array = npt.NDArray[np.float64]


def find_board_places(board: Board, cameras: Arrangement, corners: Corners, moments: int) -> Array:
    """T_world_board (B, 4, 4), m, for `moments` moments; NaN where no camera tells one.

    Args:
        board: The board.
        cameras: Where the cameras are; its boards are not looked at.
        corners: What they saw.
        moments: How many moments there are.
    """
    best = np.full((moments, 4, 4), np.nan)
    least = np.full(moments, np.inf)
    number_of = {point.tobytes(): number for number, point in enumerate(board.corners)}
    corner = np.array([number_of[point.tobytes()] for point in corners.points], dtype=np.int64)
    for number, (K, distortion) in enumerate(zip(cameras.K, cameras.distortion, strict=True)):
        own = corners.camera == number
        views = np.full((moments, len(board.corners), 2), np.nan)
        views[corners.moment[own], corner[own]] = corners.pixels[own]
        proposed = inverse(cameras.T_camera_world[number]) @ find_board_poses(board, Lens(K, distortion), views)
        is_there = np.isfinite(proposed[:, 0, 0])
        trial = replace(cameras, T_world_board=np.where(is_there[:, None, None], proposed, np.eye(4)))
        squares = np.minimum((trial.residuals(corners) ** 2).sum(axis=1), 1e6)
        cost = np.bincount(corners.moment, np.sqrt(squares), minlength=moments)
        is_better = is_there & (cost < least)
        best[is_better], least[is_better] = proposed[is_better], cost[is_better]
    return best
