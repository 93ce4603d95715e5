"""What a calibration found, and how well it agrees with what was seen."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.calibration.board import Board
from tracker.capture.camera import Camera

Array = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]
Mask = npt.NDArray[np.bool_]


@dataclass(frozen=True)
class TimeOffset:
    """How far a camera's video is out of step.

    Attributes:
        seconds: To be added to a time in the first camera's video to get the time of the same moment in this one's.
        frames: The same in frames of this camera.
        is_known: The board's motion tells it; where not, frames of one number are taken as one moment.
    """

    seconds: float
    frames: float
    is_known: bool


@dataclass(frozen=True, eq=False)
class BoardResiduals:
    """How far M corners are from where they were seen.

    Attributes:
        camera: (M,) number of the camera.
        moment: (M,) number of the moment.
        px: (M,) distance in the picture.
        pixels: (M, 2) px, where the corner was seen.
    """

    camera: Integers
    moment: Integers
    px: Array
    pixels: Array

    def choose(self, mask: Mask) -> BoardResiduals:
        """Those of a mask (M,)."""
        return BoardResiduals(self.camera[mask], self.moment[mask], self.px[mask], self.pixels[mask])

    @property
    def rms(self) -> float:
        """Root of the mean square, px; NaN of none."""
        return float(np.sqrt(np.mean(self.px**2))) if len(self.px) else float("nan")

    @property
    def median(self) -> float:
        """px; NaN of none."""
        return float(np.median(self.px)) if len(self.px) else float("nan")


@dataclass(frozen=True, eq=False)
class CameraCalibration:
    """C cameras, calibrated.

    Attributes:
        board: The board.
        cameras: The world is the first camera's frame, m.
        offsets: Of each camera; the first one's is 0.
        moments: (B,) s in the first camera's time, at which the board was looked at.
        is_left_out: (B,) moments that the cameras were not fitted to.
        T_world_board: (B, 4, 4) m; NaN where it is not known.
        residuals: At all moments, each board fitted to all cameras that saw it, the cameras fixed.
        other_cameras_residuals: At the moments left out, each board fitted to the other cameras than the one it is
            measured in.
        frame_counts: Frames of each video.
        sighting_counts: Frames of each with the board.
        warnings: What to look at, in sentences.
    """

    board: Board
    cameras: tuple[Camera, ...]
    offsets: tuple[TimeOffset, ...]
    moments: Array
    is_left_out: Mask
    T_world_board: Array
    residuals: BoardResiduals
    other_cameras_residuals: BoardResiduals
    frame_counts: tuple[int, ...]
    sighting_counts: tuple[int, ...]
    warnings: tuple[str, ...]

    @property
    def fitted(self) -> BoardResiduals:
        """At the moments that the cameras were fitted to."""
        return self.residuals.choose(~self.is_left_out[self.residuals.moment])

    @property
    def left_out(self) -> BoardResiduals:
        """At the moments that were left out."""
        return self.residuals.choose(self.is_left_out[self.residuals.moment])
