"""Where a board is, seen by one camera: planar, so that there are two answers and the better one is taken."""

from __future__ import annotations

import cv2
import numpy as np
import numpy.typing as npt

from tracker.calibration.board import Board
from tracker.calibration.corner_detector import MIN_CORNERS
from tracker.calibration.lens import Lens
from tracker.geometry.se3 import transform

Array = npt.NDArray[np.float64]


def find_board_poses(board: Board, lens: Lens, corners: Array) -> Array:
    """(S, 4, 4) T_camera_board, m, of the corners (S, N, 2) px of S views; NaN where too few corners are seen."""
    poses = np.full((len(corners), 4, 4), np.nan)
    for place, view in enumerate(corners):
        is_seen = np.isfinite(view[:, 0])
        if is_seen.sum() < MIN_CORNERS:
            continue
        points, pixels = board.corners[is_seen], view[is_seen]
        try:
            done, turns, moves, _ = cv2.solvePnPGeneric(
                points, pixels, lens.K, lens.distortion, flags=cv2.SOLVEPNP_IPPE
            )
        except cv2.error:  # corners on one line, or a lens that folds over: no pose
            continue
        if not done:
            continue
        turn, move = cv2.solvePnPRefineLM(points, pixels, lens.K, lens.distortion, turns[0], moves[0])
        T = np.eye(4)
        T[:3, :3], T[:3, 3] = cv2.Rodrigues(turn)[0], move.ravel()
        if np.isfinite(T).all() and (transform(T, points)[:, 2] > 0).all():
            poses[place] = T
    return poses


def measure_transfer(board: Board, K: Array, ours: Array, theirs: Array) -> Array:
    """(S,) px: how far apart two poses (S, 4, 4) of the board in one camera's frame put its corners, at the median."""
    outline = board.corners[[0, board_edge(board), len(board.corners) - board_edge(board) - 1, len(board.corners) - 1]]
    pixels = []
    for poses in (ours, theirs):
        points = np.einsum("sij,nj->sni", poses[:, :3, :3], outline) + poses[:, None, :3, 3]
        depth = np.where(points[..., 2:] > 1e-6, points[..., 2:], np.nan)
        pixels.append(points[..., :2] / depth * [K[0, 0], K[1, 1]])
    distance = np.linalg.norm(pixels[0] - pixels[1], axis=2)
    return np.where(np.isfinite(distance).all(axis=1), np.median(distance, axis=1), np.inf)


def board_edge(board: Board) -> int:
    """Number of the last corner of the first row."""
    return 4 * board.columns - 3 if board.kind == "apriltag" else board.columns - 2
