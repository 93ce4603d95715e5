"""Calibrations that come with synchronised videos, whatever tool wrote them.

All of them say x_camera = R X + t, in pixels of their videos and in a unit of length of their own.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import cv2
import numpy as np
import numpy.typing as npt

from tracker.capture.calibration import ORTHONORMAL_TOLERANCE, nearest_rotation
from tracker.errors import CalibrationError, reads

Array = npt.NDArray[np.float64]
MAX_CALIBRATION_BYTES = 4 * 1024 * 1024
"""Of a file; a bound of ours."""


@dataclass(frozen=True, eq=False)
class VideoCamera:
    """One camera of a calibration.

    Attributes:
        name: As in the calibration.
        K: (3, 3) px.
        distortion: (n,) OpenCV.
        R: (3, 3) world to camera.
        t: (3,) in the calibration's unit.
        size: (width, height) px, or None when it is not said.
        unit_m: Metres per unit of the calibration, or None when it is not said.
        offset_s: To be added to a time of the first camera's video to get the same moment's in this one's; 0 where the
            calibration does not say it.
    """

    name: str
    K: Array
    distortion: Array = field(default_factory=lambda: np.zeros(0))
    R: Array = field(default_factory=lambda: np.eye(3))
    t: Array = field(default_factory=lambda: np.zeros(3))
    size: tuple[int, int] | None = None
    unit_m: float | None = None
    offset_s: float = 0.0

    def find_pose(self, unit_m: float) -> Array:
        """T_world_camera (4, 4), m, with `unit_m` metres per unit of the calibration."""
        T = np.eye(4)
        T[:3, :3] = self.R.T
        T[:3, 3] = -self.R.T @ self.t * unit_m
        return T


def to_array(value: Any, what: str) -> Array:
    """Numbers from outside as a float64 array; OpenCV's `{rows, cols, data}` and `{sizes, data}` are ones too."""
    if isinstance(value, dict) and "data" in value and ({"rows", "cols"} <= value.keys() or "sizes" in value):
        return _to_sized_array(value, what)
    try:
        array = np.asarray(value)
        if array.dtype.kind not in "fiu" or array.size > 10_000:
            raise ValueError
        array = array.astype(np.float64)
    except (ValueError, TypeError, OverflowError):
        raise CalibrationError(f"{what}: is not an array of numbers.") from None
    if not np.isfinite(array).all():
        raise CalibrationError(f"{what}: holds NaN or infinity.")
    return array


def _to_sized_array(value: dict[str, Any], what: str) -> Array:
    flat = to_array(value["data"], what).ravel()
    sizes = value["sizes"] if "sizes" in value else [value["rows"], value["cols"]]
    sizes = sizes if isinstance(sizes, list) else [sizes]
    if not sizes or any(type(n) is not int or n < 0 for n in sizes) or math.prod(sizes) != flat.size:
        raise CalibrationError(f"{what}: says {str(sizes)[:60]} numbers and has {flat.size}.")
    return flat.reshape(sizes)


@reads(CalibrationError, "a camera: K of 3x3 numbers, R of 3x3 or a rotation vector, t of three")
def make_camera(name: str, what: str, values: dict[str, Any]) -> VideoCamera:
    """A camera from its values: K, and if known distortion, R (3x3 or rotation vector), t, size."""
    K = to_array(values["K"], f"{what}: K")
    if K.shape != (3, 3):
        raise CalibrationError(f"{what}: K has shape {K.shape}; needed 3x3.")
    distortion = to_array(values.get("distortion", []), f"{what}: distortion").ravel()
    R = to_array(values.get("R", np.eye(3)), f"{what}: R")
    if R.size == 3:
        R = np.asarray(cv2.Rodrigues(R.reshape(3, 1))[0], dtype=np.float64)
    if R.shape != (3, 3):
        raise CalibrationError(f"{what}: R has shape {R.shape}; needed 3x3 or a rotation vector.")
    error = float(np.abs(R.T @ R - np.eye(3)).max())
    if error > ORTHONORMAL_TOLERANCE or np.linalg.det(R) < 0:
        raise CalibrationError(f"{what}: R is not a rotation (off by {error:.3g}, determinant {np.linalg.det(R):.3g}).")
    t = to_array(values.get("t", np.zeros(3)), f"{what}: t").ravel()
    if t.shape != (3,):
        raise CalibrationError(f"{what}: t has {t.size} numbers; needed 3.")
    size = None
    if values.get("size") is not None:
        numbers = to_array(values["size"], f"{what}: size").ravel()
        if numbers.size != 2 or (numbers < 1).any() or (numbers > 1e6).any():
            raise CalibrationError(f"{what}: the image size is {numbers.tolist()}; needed width and height.")
        size = (int(numbers[0]), int(numbers[1]))
    return VideoCamera(name, K, distortion, nearest_rotation(R), t, size, values.get("unit_m"))
