"""Where the pixels of the image before are now: optical flow of a part of a colour image, checked both ways."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.observation.image_part import frame_points

AGREES = 1.0
"""Flow there and back must end so near to where it began, px."""

ALIKE = 12.0
"""Around its ends the mean difference of brightness must be less, levels of 255: flow that is smooth and
wrong can agree there and back too."""

AROUND = 7
"""Side of a window, px."""


@dataclass(frozen=True)
class ImageFlow:
    """Flow as an ideal pinhole camera would show it.

    Attributes:
        K: (3, 3) px; pixel (0, 0) is the part's first.
        T_world_camera: (4, 4).
        now: (H, W, 2) float32 column and row, px of the part, where what a pixel showed before is now; NaN where that
            is not known.
    """

    K: npt.NDArray[np.float64]
    T_world_camera: npt.NDArray[np.float64]
    now: npt.NDArray[np.float32]


def find_image_flow(
    before: npt.NDArray[np.uint8],
    now: npt.NDArray[np.uint8],
    camera: Camera,
    points: npt.NDArray[np.float64],
    margin: float,
    is_covered: npt.NDArray[np.bool_] | None = None,
) -> ImageFlow | None:
    """Flow from one image to the next around points; None where they are out of sight.

    It is OpenCV's dense inverse search (Kroeger et al., "Fast Optical Flow using Dense Inverse Search", ECCV 2016).
    [T16] §3.3 takes the flow of Ballan and Cortelazzo 2008 and does not say how it is found.

    Args:
        before: (H, W, 3) image before, as recorded.
        now: (H, W, 3) image now.
        camera: Of both.
        points: (N, 2) px of an ideal lens.
        margin: px around them.
        is_covered: (H, W) pixels from which no flow is taken, [T16] §4.4.1; None for none.
    """
    window = frame_points(camera, points, margin)
    if window is None:
        return None
    first, second = (_grey(window.cut(image)) for image in (before, now))
    search = cv2.DISOpticalFlow.create(cv2.DISOPTICAL_FLOW_PRESET_FAST)
    no_guess: Any = None  # OpenCV's types do not say that there may be none
    there = search.calc(first, second, no_guess)
    back = search.calc(second, first, no_guess)
    columns, rows = np.meshgrid(np.arange(window.width, dtype=np.float32), np.arange(window.height, dtype=np.float32))
    ends = there + np.dstack([columns, rows])
    returned = cv2.remap(back, ends[:, :, 0], ends[:, :, 1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_CONSTANT)
    inside = (ends >= 0).all(axis=2) & (ends[:, :, 0] <= window.width - 1) & (ends[:, :, 1] <= window.height - 1)
    known = inside & (np.linalg.norm(there + returned, axis=2) < AGREES)
    moved = cv2.remap(second, ends[:, :, 0], ends[:, :, 1], cv2.INTER_LINEAR)
    known &= cv2.blur(cv2.absdiff(first, moved), (AROUND, AROUND)) < ALIKE
    if is_covered is not None:
        known &= window.cut(is_covered.astype(np.uint8)) == 0
    return ImageFlow(window.K, camera.T_world_camera, np.where(known[:, :, None], ends, np.float32(np.nan)))


def _grey(part: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint8]:
    return np.asarray(cv2.cvtColor(np.ascontiguousarray(part), cv2.COLOR_RGB2GRAY), dtype=np.uint8)
