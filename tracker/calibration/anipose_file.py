"""Cameras as Anipose's `calibration.toml`: rotation vectors, world to camera, metres."""

from __future__ import annotations

import json
from collections.abc import Sequence

import cv2
import numpy as np

from tracker.capture.camera import Camera


def write_anipose(cameras: Sequence[Camera], offsets_s: Sequence[float] = (), error_px: float = 0.0) -> bytes:
    """The file.

    Args:
        cameras: The world is theirs.
        offsets_s: To be added to a time of the first camera's video to get each one's; in the metadata, which Anipose
            does not read.
        error_px: As Anipose has it: how far the cameras disagree.
    """
    lines = []
    for number, camera in enumerate(cameras):
        T = camera.T_camera_world
        turn = np.asarray(cv2.Rodrigues(np.ascontiguousarray(T[:3, :3]))[0]).ravel()
        lines += [
            f"[cam_{number}]",
            f"name = {_text(camera.id)}",
            f"size = [ {camera.width}, {camera.height},]",
            f"matrix = [ {' '.join(f'{_list(row)},' for row in camera.K)}]",
            f"distortions = {_list(camera.distortion if camera.distortion.size else np.zeros(5))}",
            f"rotation = {_list(turn)}",
            f"translation = {_list(T[:3, 3])}",
            "",
        ]
    lines += ["[metadata]", "adjusted = true", f"error = {_real(error_px)}", 'unit = "m"']
    if offsets_s:
        lines += ["", "[metadata.time_offsets_s]"]
        lines += [f"{_text(camera.id)} = {_real(s)}" for camera, s in zip(cameras, offsets_s, strict=True)]
    return ("\n".join(lines) + "\n").encode(errors="replace")


def _text(value: str) -> str:
    """As JSON has it, but no pairs of surrogates, which TOML refuses, and no bare DEL."""
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")


def _list(values: np.ndarray) -> str:
    return "[ " + " ".join(f"{_real(value)}," for value in values.tolist()) + "]"


def _real(value: float) -> str:
    text = repr(float(value))
    return text if any(sign in text for sign in ".einf") else f"{text}.0"
