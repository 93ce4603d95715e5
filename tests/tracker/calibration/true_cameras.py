"""Three cameras and the board at some moments, all in their true places, and the corners that were seen there."""

from __future__ import annotations

import numpy as np

from tests.tracker.calibration.filmed_board import BOARD, film, place_board
from tracker.calibration.arrangement import Arrangement
from tracker.calibration.moments import read_corners

FILMED = film(3, seconds=6.0, fps=10.0, spread=0.6)
TIMES = np.arange(8) * 0.4


def true_arrangement() -> Arrangement:
    distortion = np.zeros((3, 12))
    distortion[:, :5] = [camera.distortion for camera in FILMED.cameras]
    return Arrangement(
        np.array([camera.K for camera in FILMED.cameras]),
        distortion,
        np.array([camera.T_camera_world for camera in FILMED.cameras]),
        np.array([place_board(BOARD, time) for time in TIMES]),
        np.zeros(3),
        np.array([[camera.width, camera.height] for camera in FILMED.cameras], dtype=np.float64),
    )


TRUTH = true_arrangement()
CORNERS = read_corners(BOARD, FILMED.sight_all(noise_px=0.0), TIMES, np.zeros(3), np.ones(3, dtype=bool))
