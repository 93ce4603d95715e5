"""A track as one table, for spreadsheets and data frames."""

from __future__ import annotations

import csv
import io

import numpy as np

from tracker.errors import TrackingError
from tracker.tracking.track import Track


def write_csv(track: Track) -> bytes:
    """One line per frame and joint: frame, status, joint, x, y, z (world, m), then u and v (px) of every camera.

    Lengths have six decimals, 1 µm, pixels three. A joint behind a camera has empty cells there.

    Raises:
        TrackingError: The track has no joints: it follows nothing but rigid objects.
    """
    if not track.joint_names:
        raise TrackingError("The track has no joints, only rigid objects; export their poses as npz or glb.")
    text = io.StringIO(newline="")
    writer = csv.writer(text, lineterminator="\n")
    places = [f"{axis}_{camera}" for camera in track.camera_ids for axis in "uv"]
    writer.writerow(["frame", "status", "joint", "x", "y", "z", *places])
    names = [_as_text(name) for name in track.joint_names]
    pixels = track.joints_2d.transpose(0, 2, 1, 3).reshape(len(track.frame), len(names), -1)
    for row, (frame, status) in enumerate(zip(track.frame, track.status, strict=True)):
        for name, point, place in zip(names, track.joints_3d[row], pixels[row], strict=True):
            writer.writerow([frame, status, name, *(_number(v, 6) for v in point), *(_number(v, 3) for v in place)])
    return text.getvalue().encode("utf-8")


def _number(value: float, decimals: int) -> str:
    return f"{value:.{decimals}f}" if np.isfinite(value) else ""


def _as_text(name: str) -> str:
    """A name that no spreadsheet takes for a formula: objects are named by people."""
    return f"'{name}" if name[:1] in ("=", "+", "-", "@", "\t", "\r") else name
