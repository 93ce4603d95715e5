"""Colour images that were exposed too short."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import numpy.typing as npt

from tracker.capture.frame import Frame
from tracker.capture.grey import is_grey

DIM, BRIGHT = 128.0, 180.0
"""Of 255: an image whose brightest hundredth is below the first is brightened to the second, which it has in well
exposed recordings (179 to 232 in six; 164 at least)."""

SAMPLES = 5000
"""Pixels that are looked at; in 1280x1024 px that takes 0.2 ms."""


def brighten(color: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint8]:
    """A dim image (H, W, 3) with all channels times what it lacks; one without colours or not dim as it is."""
    step = 1 + int(np.sqrt(color.shape[0] * color.shape[1] / SAMPLES))
    brightest = float(np.percentile(color[::step, ::step].max(axis=2), 99.0))
    if not 0.0 < brightest < DIM or is_grey(color):
        return color
    levels = np.minimum(np.arange(256) * (BRIGHT / brightest), 255.0).round().astype(np.uint8)
    return cv2.LUT(color, levels).astype(np.uint8, copy=False)


def brighten_frame(frame: Frame) -> Frame:
    """The frame with a brightened image, if it has one."""
    return frame if frame.color is None else replace(frame, color=brighten(frame.color))
