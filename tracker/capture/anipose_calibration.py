"""Anipose's `calibration.toml`: a table for each camera, rotation vectors, world to camera."""

from __future__ import annotations

import tomllib
from dataclasses import replace

from tracker.capture.video_calibration import VideoCamera, make_camera
from tracker.errors import CalibrationError, reading

LONGEST_OFFSET_S = 600.0
"""That `handloom calibrate-cameras` looks for."""


def parse_anipose(data: bytes, file: str) -> list[VideoCamera]:
    """Cameras of a calibration in the order of the file."""
    with reading(CalibrationError, file, "valid TOML"):
        document = tomllib.loads(data.decode("utf-8"))
    metadata = document.get("metadata")
    is_metric = isinstance(metadata, dict) and metadata.get("unit") == "m"  # as `handloom calibrate-cameras` writes it
    offsets = metadata.get("time_offsets_s") if isinstance(metadata, dict) and is_metric else None
    cameras = []
    for key, table in document.items():
        if key == "metadata" or not isinstance(table, dict):
            continue
        what = f"{file}: [{key}]"
        missing = [name for name in ("matrix", "rotation", "translation") if name not in table]
        if missing:
            raise CalibrationError(f"{what} has no {', '.join(missing)}; an Anipose camera has them.")
        if table.get("fisheye"):
            raise CalibrationError(f"{what} is a fisheye camera; needed one with OpenCV's usual distortion.")
        values = {
            "K": table["matrix"],
            "distortion": table.get("distortions", []),
            "R": table["rotation"],
            "t": table["translation"],
            "size": table.get("size"),
            "unit_m": 1.0 if is_metric else None,
        }
        camera = make_camera(str(table.get("name", key))[:100], what, values)
        offset = offsets.get(camera.name, 0.0) if isinstance(offsets, dict) else 0.0
        is_told = isinstance(offset, int | float) and abs(offset) <= LONGEST_OFFSET_S
        cameras.append(replace(camera, offset_s=float(offset) if is_told else 0.0))
    if not cameras:
        raise CalibrationError(f"{file}: holds no camera; needed tables like [cam_0].")
    return cameras
