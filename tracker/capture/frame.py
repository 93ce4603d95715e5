"""One moment of one camera."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera


@dataclass(frozen=True, eq=False)
class Frame:
    """Images of one camera at one frame number.

    Attributes:
        index: Frame number, from 0.
        camera: Id of the camera.
        color: (H, W, 3) uint8 RGB, or None.
        depth: (H, W) float32, m along the optical axis, 0 where there is no value, or None.
        is_hand: (H, W) pixels known to be of a hand's own colour, or None where nobody has looked.
    """

    index: int
    camera: str
    color: npt.NDArray[np.uint8] | None
    depth: npt.NDArray[np.float32] | None
    is_hand: npt.NDArray[np.bool_] | None = None


@dataclass(frozen=True, eq=False)
class CameraFrame:
    """A frame and the camera that took it.

    Attributes:
        camera: As the images are: without distortion where they were undistorted.
        frame: Its images.
    """

    camera: Camera
    frame: Frame
