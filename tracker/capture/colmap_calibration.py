"""COLMAP's text: `cameras.txt` has the lenses, `images.txt` where each was, world to camera.

COLMAP puts the centre of the first pixel at (0.5, 0.5), we at (0, 0).
"""

from __future__ import annotations

from pathlib import PurePosixPath

import numpy as np
import numpy.typing as npt

from tracker.capture.video_calibration import VideoCamera, make_camera
from tracker.errors import CalibrationError, reading

Array = npt.NDArray[np.float64]

HALF_PIXEL = 0.5
"""COLMAP puts the corner of the top-left pixel at (0, 0), we its centre; px."""
MAX_COLMAP_CAMERAS = 64
"""Of one reconstruction; a bound of ours."""

_MODELS = {
    "SIMPLE_PINHOLE": ("f", "cx", "cy"),
    "PINHOLE": ("fx", "fy", "cx", "cy"),
    "SIMPLE_RADIAL": ("f", "cx", "cy", "k1"),
    "RADIAL": ("f", "cx", "cy", "k1", "k2"),
    "OPENCV": ("fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2"),
    "FULL_OPENCV": ("fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"),
}


def parse_colmap(cameras: bytes, images: bytes, file: str) -> list[VideoCamera]:
    """Cameras in the order of their images; one image each, or several of one camera that stood still.

    Args:
        cameras: `cameras.txt`.
        images: `images.txt`; a camera is called by its image's folder, or by the image where it lies in none.
        file: For messages.
    """
    with reading(CalibrationError, file, "COLMAP's cameras.txt and images.txt"):
        lenses = {words[0]: words for words in _rows(cameras)}
        found: dict[str, VideoCamera] = {}
        for words in _rows(images)[: 10_000 * MAX_COLMAP_CAMERAS]:
            if len(words) < 10 or words[8] not in lenses:
                continue  # the points of an image, or an image whose camera is missing
            path = PurePosixPath(" ".join(words[9:]))
            name = str(path.parent) if str(path.parent) != "." else path.stem if path.suffix else path.name
            camera = _make(name[:100], f"{file}: {name[:60]}", lenses[words[8]], [float(word) for word in words[1:8]])
            known = found.setdefault(name, camera)
            if np.abs(known.R - camera.R).max() > 1e-3 or np.abs(known.t - camera.t).max() > 1e-3 * _size(known):
                raise CalibrationError(
                    f"{file}: {name[:60]} has several images from different places; needed a camera that stands still."
                )
            if len(found) > MAX_COLMAP_CAMERAS:
                raise CalibrationError(
                    f"{file}: has more than {MAX_COLMAP_CAMERAS} cameras; give each camera a folder."
                )
    if not found:
        raise CalibrationError(f"{file}: names no image of a camera in cameras.txt; needed one for each camera.")
    return list(found.values())


def to_wxyz(R: Array) -> Array:
    """Unit quaternion (4,) of a rotation (3, 3), w >= 0."""
    values, vectors = np.linalg.eigh(
        np.array(
            [
                [R[0, 0] + R[1, 1] + R[2, 2], R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]],
                [R[2, 1] - R[1, 2], R[0, 0] - R[1, 1] - R[2, 2], R[0, 1] + R[1, 0], R[0, 2] + R[2, 0]],
                [R[0, 2] - R[2, 0], R[0, 1] + R[1, 0], R[1, 1] - R[0, 0] - R[2, 2], R[1, 2] + R[2, 1]],
                [R[1, 0] - R[0, 1], R[0, 2] + R[2, 0], R[1, 2] + R[2, 1], R[2, 2] - R[0, 0] - R[1, 1]],
            ]
        )
    )
    best = vectors[:, int(np.argmax(values))]
    return best if best[0] >= 0 else -best


def _rotation(wxyz: Array) -> Array:
    w, x, y, z = wxyz / np.linalg.norm(wxyz)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def _make(name: str, what: str, words: list[str], pose: list[float]) -> VideoCamera:
    model = words[1]
    if model not in _MODELS:
        raise CalibrationError(f"{what}: has the camera model {model[:40]!r}; needed one of {', '.join(_MODELS)}.")
    numbers = [float(word) for word in words[4:]]
    if len(numbers) != len(_MODELS[model]):
        raise CalibrationError(f"{what}: {model} has {len(_MODELS[model])} parameters; found {len(numbers)}.")
    values = dict(zip(_MODELS[model], numbers, strict=True))
    fx, fy = values.get("fx", values.get("f")), values.get("fy", values.get("f"))
    distortion = [values.get(key, 0.0) for key in ("k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6")]
    count = next((size for size in (8, 5, 4) if any(distortion[{8: 5, 5: 4, 4: 0}[size] :])), 0)
    K = [[fx, 0, values["cx"] - HALF_PIXEL], [0, fy, values["cy"] - HALF_PIXEL], [0, 0, 1]]
    if not np.isfinite(pose).all() or not 0.5 < np.linalg.norm(pose[:4]) < 2.0:
        raise CalibrationError(f"{what}: its quaternion is {pose[:4]}; needed one of length 1.")
    return make_camera(
        name,
        what,
        {
            "K": K,
            "distortion": distortion[:count],
            "R": _rotation(np.array(pose[:4])),
            "t": pose[4:],
            "size": [int(words[2]), int(words[3])],
        },
    )


def _rows(data: bytes) -> list[list[str]]:
    lines = data.decode("utf-8").splitlines()
    return [line.split() for line in lines if line.strip() and not line.lstrip().startswith("#")]


def _size(camera: VideoCamera) -> float:
    return max(float(np.linalg.norm(camera.t)), 1e-6)
