"""Lenses that were calibrated before, from whatever file of cameras they are in."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tracker.calibration.lens import Lens
from tracker.capture.calibration import check_distortion, check_intrinsics
from tracker.capture.importers.synced_videos import read_calibration
from tracker.capture.listed_files import ListedFiles, list_files
from tracker.errors import CalibrationError


def load_lenses(path: Path) -> dict[str, Lens]:
    """Lenses by the names of their cameras, from a file or a folder that a recording's calibration may be in too.

    Raises:
        CalibrationError: There is none, or one is impossible.
    """
    if not path.exists():
        raise CalibrationError(f"{path}: there is no such file of lenses.")
    files = list_files(path) if path.is_dir() else ListedFiles(path.parent, (path.name,))
    cameras, _ = read_calibration(files)
    if not cameras:
        raise CalibrationError(
            f"{path}: holds no camera; needed Anipose's .toml, OpenCV's .yaml, .json or .npz, c0.dat, or COLMAP's text."
        )
    for camera in cameras:
        size = camera.size or (round(2 * camera.K[0, 2]), round(2 * camera.K[1, 2]))
        check_intrinsics(f"{path.name}: {camera.name}", camera.K, *size)
        check_distortion(f"{path.name}: {camera.name}", camera.distortion)
    return {camera.name: Lens(camera.K, np.asarray(camera.distortion)) for camera in cameras}
