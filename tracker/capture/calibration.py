"""Is this a possible camera? Checks of intrinsics and poses from outside."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from tracker.errors import CalibrationError

Array = npt.NDArray[np.float64]

DISTORTION_SIZES = (0, 4, 5, 8, 12, 14)
"""Coefficients in OpenCV's order, which knows models of so many."""
MAX_SIDE = 16384
"""px of an image."""
MAX_PIXELS = 64_000_000
"""Of an image; a bound of ours against images that only claim to be so large."""
ORTHONORMAL_TOLERANCE = 1e-3
"""Of each entry of RᵀR: calibrations are written with few digits."""


def check_image_size(what: str, width: int, height: int) -> None:
    """An image of at least 8x8 and at most 64 million pixels."""
    if not (8 <= width <= MAX_SIDE and 8 <= height <= MAX_SIDE and width * height <= MAX_PIXELS):
        raise CalibrationError(
            f"{what}: image size {width}x{height} px; needed 8 to {MAX_SIDE} px a side and at most {MAX_PIXELS} pixels."
        )


def check_intrinsics(what: str, K: Array, width: int, height: int) -> None:
    """K (3, 3) px of a pinhole: zero skew, focal lengths of the order of the image, principal point not far outside."""
    if K.shape != (3, 3) or not np.isfinite(K).all():
        raise CalibrationError(f"{what}: K must be 3 rows of 3 finite numbers.")
    if np.abs(K[2] - [0, 0, 1]).max() > 1e-9 or K[1, 0] != 0:
        raise CalibrationError(f"{what}: K is {K.tolist()}; needed [[fx, 0, cx], [0, fy, cy], [0, 0, 1]].")
    if abs(K[0, 1]) > 1e-9:
        raise CalibrationError(f"{what}: K has skew {K[0, 1]:g}; calibrate again with zero skew.")
    side = max(width, height)
    for name, focal in (("fx", K[0, 0]), ("fy", K[1, 1])):
        if not 0.05 * side <= focal <= 100 * side:
            raise CalibrationError(
                f"{what}: {name} is {focal:g} px for an image of {width}x{height}; "
                f"needed {0.05 * side:g} to {100 * side:g} px. Is it in pixels of this image size?"
            )
    if abs(K[0, 2] - width / 2) > 2 * width or abs(K[1, 2] - height / 2) > 2 * height:
        raise CalibrationError(
            f"{what}: the principal point ({K[0, 2]:g}, {K[1, 2]:g}) px is far outside the {width}x{height} image."
        )


def check_distortion(what: str, distortion: Array) -> None:
    """OpenCV's distortion coefficients, (n,)."""
    if distortion.ndim != 1 or distortion.size not in DISTORTION_SIZES:
        raise CalibrationError(
            f"{what}: {distortion.size} distortion coefficients; "
            f"OpenCV has {', '.join(map(str, DISTORTION_SIZES[:-1]))} or {DISTORTION_SIZES[-1]}."
        )
    if not np.isfinite(distortion).all() or (distortion.size and np.abs(distortion).max() > 1e4):
        raise CalibrationError(f"{what}: distortion coefficients must be finite and below 10000.")


def check_rigid(what: str, T: Array) -> None:
    """T (4, 4) is a rotation and a translation (m) of at most a kilometre."""
    if T.shape != (4, 4) or not np.isfinite(T).all():
        raise CalibrationError(f"{what}: needed 4 rows of 4 finite numbers.")
    if np.abs(T[3] - [0, 0, 0, 1]).max() > 1e-9:
        raise CalibrationError(f"{what}: the last row is {T[3].tolist()}; needed [0, 0, 0, 1].")
    R = T[:3, :3]
    if np.abs(R).max() > 2:
        raise CalibrationError(f"{what}: the upper left 3x3 is not a rotation (it scales).")
    error = float(np.abs(R.T @ R - np.eye(3)).max())
    if error > ORTHONORMAL_TOLERANCE:
        raise CalibrationError(f"{what}: the upper left 3x3 is not a rotation (off by {error:.3g}).")
    if np.linalg.det(R) < 0:
        raise CalibrationError(f"{what}: the upper left 3x3 mirrors; needed a rotation.")
    if np.abs(T[:3, 3]).max() > 1000:
        raise CalibrationError(f"{what}: the translation is {np.abs(T[:3, 3]).max():g} m; is it in metres?")


def nearest_rotation(R: Array) -> Array:
    """The rotation (3, 3) nearest to a nearly orthonormal R, in the Frobenius norm."""
    U, _, Vt = np.linalg.svd(R)
    return U @ np.diag([1.0, 1.0, float(np.sign(np.linalg.det(U @ Vt)))]) @ Vt
