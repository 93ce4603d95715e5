"""A fingertip that was found in an image."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt


@dataclass(frozen=True)
class Detection:
    """δ_s of [T16] §3.2.5 with its points δ'_s.

    Attributes:
        center_px: (2,) column and row, px of the whole image without distortion.
        box: (4,) left, top, right, bottom, px of the same.
        box_rays: (4,) the same as x/z, y/z, x/z, y/z in the camera's frame: it stays when the region changes.
        confidence: c_s; at 3.0, c_thr of the paper, most are right.
        depth: Of the fingertip as the votes have it, m.
        points: (N, 3) float64 world, m: pixels of hand in the box about as far away as the fingertip.
        centroid: (3,) their mean, world, m.
    """

    center_px: npt.NDArray[np.float64]
    box: npt.NDArray[np.float64]
    box_rays: npt.NDArray[np.float64]
    confidence: float
    depth: float
    points: npt.NDArray[np.float64]
    centroid: npt.NDArray[np.float64]
