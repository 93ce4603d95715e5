"""Cameras as one YAML file that OpenCV's `FileStorage` reads: a map for each camera, world to camera, metres."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from tracker.capture.camera import Camera


def write_opencv(cameras: Sequence[Camera]) -> bytes:
    """The file; `FileStorage` wants names of letters, digits and underscores, the real ones stand beside them."""
    lines = ["%YAML:1.0", "---"]
    for key, camera in zip(_choose_keys([camera.id for camera in cameras]), cameras, strict=True):
        T = camera.T_camera_world
        lines += [
            f"{key}:",
            f'   name: "{re.sub(chr(92) * 2 + "|" + chr(34), "_", camera.id)}"',
            f"   image_width: {camera.width}",
            f"   image_height: {camera.height}",
            *_matrix("camera_matrix", camera.K),
            *_matrix(
                "distortion_coefficients", camera.distortion[None] if camera.distortion.size else np.zeros((1, 5))
            ),
            *_matrix("R", T[:3, :3]),
            *_matrix("T", T[:3, 3:]),
        ]
    return ("\n".join(lines) + "\n").encode()


def _choose_keys(names: Sequence[str]) -> list[str]:
    """What `FileStorage` accepts, one for each; names that would become the same are all numbered."""
    plain = [re.sub(r"[^A-Za-z0-9_]", "_", name) for name in names]
    numbered = [f"camera_{number}_{name}" for number, name in enumerate(plain)]
    keys = [name if name[:1].isalpha() else other for name, other in zip(plain, numbered, strict=True)]
    return keys if len(set(keys)) == len(keys) else numbered


def _matrix(name: str, values: np.ndarray) -> list[str]:
    numbers = [repr(float(value)) for value in values.ravel()]
    rows = [", ".join(numbers[start : start + 3]) for start in range(0, len(numbers), 3)]
    return [
        f"   {name}: !!opencv-matrix",
        f"      rows: {values.shape[0]}",
        f"      cols: {values.shape[1]}",
        "      dt: d",
        f"      data: [ {(',' + chr(10) + '          ').join(rows)} ]",
    ]
