"""A small calibration written down by hand: every number in it is known."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from tests.tracker.calibration.filmed_board import BOARD, film
from tracker.calibration.camera_calibration import BoardResiduals, CameraCalibration, TimeOffset


def found_calibration(**changes: Any) -> CameraCalibration:
    """Two cameras and three moments: the second's board is not placed, the third was left out and seen by both."""
    residuals = BoardResiduals(
        camera=np.array([0, 0, 1, 0, 1]),
        moment=np.array([0, 0, 0, 2, 2]),
        px=np.array([0.3, 0.4, 1.2, 0.6, 5.0]),
        pixels=np.array([[100.0, 100.0], [700.0, 300.0], [640.0, 360.0], [1000.0, 600.0], [200.0, 600.0]]),
    )
    places = np.tile(np.eye(4), (3, 1, 1))
    places[1] = np.nan
    result = CameraCalibration(
        board=BOARD,
        cameras=film(2).cameras,
        offsets=(TimeOffset(0.0, 0.0, True), TimeOffset(-0.0335, -1.005, True)),
        moments=np.array([0.0, 0.5, 1.0]),
        is_left_out=np.array([False, False, True]),
        T_world_board=places,
        residuals=residuals,
        other_cameras_residuals=residuals.choose(np.array([False, False, False, False, True])),
        frame_counts=(90, 91),
        sighting_counts=(60, 45),
        warnings=(),
    )
    return replace(result, **changes)
