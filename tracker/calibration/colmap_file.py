"""Cameras as COLMAP's text: `cameras.txt`, `images.txt` and an empty `points3D.txt`.

COLMAP puts the centre of the first pixel at (0.5, 0.5): half a pixel is added here, and taken off by
`tracker.capture.colmap_calibration`.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.capture.colmap_calibration import HALF_PIXEL, to_wxyz
from tracker.errors import CalibrationError

Array = npt.NDArray[np.float64]


def write_colmap(cameras: Sequence[Camera]) -> dict[str, bytes]:
    """Contents by file name; each camera has one image, in a folder of its name, world to camera, m.

    Raises:
        CalibrationError: A camera has more coefficients of distortion than COLMAP's models.
    """
    lenses = ["# CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]"]
    images = ["# IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME", "# POINTS2D[] as (X, Y, POINT3D_ID)"]
    for number, camera in enumerate(cameras, 1):
        model, own = _choose_model(camera)
        K = camera.K
        values = [K[0, 0], K[1, 1], K[0, 2] + HALF_PIXEL, K[1, 2] + HALF_PIXEL, *own]
        lenses.append(f"{number} {model} {camera.width} {camera.height} {_join(values)}")
        T = camera.T_camera_world
        name = f"{chr(95).join(camera.id.split())}/000000.png"  # as COLMAP has rigs: a folder for each camera
        images += [f"{number} {_join([*to_wxyz(T[:3, :3]), *T[:3, 3]])} {number} {name}", ""]
    return {
        "cameras.txt": ("\n".join(lenses) + "\n").encode(),
        "images.txt": ("\n".join(images) + "\n").encode(),
        "points3D.txt": b"# POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[] as (IMAGE_ID, POINT2D_IDX)\n",
    }


def _choose_model(camera: Camera) -> tuple[str, Array]:
    d = camera.distortion
    if d.size > 8 and d[8:].any():
        raise CalibrationError(f"{camera.id}: has {d.size} coefficients of distortion; COLMAP's models have at most 8.")
    full = np.zeros(8)
    full[: min(d.size, 8)] = d[:8]
    if not full.any():
        return "PINHOLE", np.zeros(0)
    return ("FULL_OPENCV", full) if full[4:].any() else ("OPENCV", full[:4])


def _join(values: Sequence[float]) -> str:
    return " ".join(repr(float(value)) for value in values)
