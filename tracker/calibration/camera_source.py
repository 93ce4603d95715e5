"""What a camera filmed of the board: a video, or a folder of images, as a stream of grey pictures."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
import numpy.typing as npt

from tracker.capture.document import read_regular_file
from tracker.capture.image_file import COLOR_SUFFIXES, decode_color
from tracker.capture.numbered_files import sort_naturally
from tracker.capture.video_file import VIDEO_SUFFIXES, VideoFile
from tracker.errors import CalibrationError, FrameError, say_count

Grey = npt.NDArray[np.uint8]

MAX_CAMERAS = 16
"""What issue and tests reach for; the pairs of cameras, and the time they take, grow with the square."""

MAX_IMAGE_BYTES = 64 * 1024 * 1024
"""Of a still of a camera; a bound of ours."""
USUAL_FPS = 30.0
"""Where neither a video nor anybody says it; times are then only as true as this."""


@dataclass(frozen=True)
class CameraSource:
    """One camera's pictures.

    Attributes:
        id: Name of the camera: that of the video without its suffix, or of the folder.
        path: The video or the folder.
        images: Names of the images in the folder in their order; empty for a video.
        fps: Frames a second; 0 when nobody says it.
        promised: How many frames there should be.
    """

    id: str
    path: Path
    images: tuple[str, ...]
    fps: float
    promised: int

    def read(self) -> Iterator[tuple[float, Grey]]:
        """Each frame's time, s, and its pixels (H, W), grey, in order; a folder's frames come at `fps`.

        Raises:
            FrameError: A frame cannot be decoded, or its size differs from the first one's.
        """
        first: tuple[int, ...] | None = None
        for index, (time_s, image) in enumerate(self._read_video() if not self.images else self._read_folder()):
            if first is not None and image.shape != first:
                raise FrameError(
                    f"{self.id}, frame {index}: is {image.shape[1]}x{image.shape[0]} px, the first one "
                    f"{first[1]}x{first[0]}; needed one size."
                )
            first = image.shape
            yield time_s, image

    def _read_video(self) -> Iterator[tuple[float, Grey]]:
        for time_s, image in VideoFile(self.path.parent, self.path.name).images():
            yield time_s, cv2.cvtColor(image, cv2.COLOR_BGR2GRAY).astype(np.uint8, copy=False)

    def _read_folder(self) -> Iterator[tuple[float, Grey]]:
        for index, name in enumerate(self.images):
            data = read_regular_file(self.path / name, MAX_IMAGE_BYTES, FrameError)
            image = decode_color(data, f"{self.id}/{name}")
            yield index / (self.fps or USUAL_FPS), cv2.cvtColor(image, cv2.COLOR_RGB2GRAY).astype(np.uint8, copy=False)


def find_sources(paths: list[Path], fps: float | None = None) -> list[CameraSource]:
    """The cameras among what was named: videos, folders of images, or one folder that holds either.

    Args:
        paths: In the order of the cameras.
        fps: Frames a second of image folders.

    Raises:
        CalibrationError: Nothing is there, or fewer than 2 or more than `MAX_CAMERAS` cameras.
        FrameError: A video cannot be read.
    """
    if len(paths) == 1 and paths[0].is_dir() and not _list(paths[0], COLOR_SUFFIXES):
        paths = _list_cameras(paths[0]) or paths
    if fault := find_count_fault([path.name for path in paths]):
        raise CalibrationError(fault)
    names = [path.stem if path.is_file() else path.name for path in paths]
    if len(set(names)) < len(names):
        names = [f"cam{index}" for index in range(len(paths))]
    return [open_source(name, path, fps) for name, path in zip(names, paths, strict=True)]


def _list_cameras(folder: Path) -> list[Path]:
    """The videos in a folder or, where there are none, its folders of images."""
    videos = _list(folder, VIDEO_SUFFIXES)
    folders = [entry.name for entry in folder.iterdir() if entry.is_dir() and _list(entry, COLOR_SUFFIXES)]
    return [folder / name for name in sort_naturally(videos or folders)]


def find_count_fault(names: Sequence[str]) -> str:
    """Why this many cameras cannot be calibrated together; empty when they can."""
    if 2 <= len(names) <= MAX_CAMERAS:
        return ""
    shown = f" ({', '.join(names[:4])}{', ...' if len(names) > 4 else ''})" if names else ""
    return (
        f"{say_count(len(names), 'camera')}{shown}; needed 2 to {MAX_CAMERAS}: name one video or folder of images for "
        "each, "
        + ("or calibrate them in groups that share a camera." if len(names) > 2 else "or a folder that holds them.")
    )


def open_source(name: str, path: Path, fps: float | None = None) -> CameraSource:
    """One camera's video or folder of images; `fps` is for what does not say it.

    Raises:
        CalibrationError: Nothing is there, or no images are in the folder.
        FrameError: The video cannot be read.
    """
    if not path.exists():
        raise CalibrationError(f"{name}: {path} does not exist.")
    if path.is_dir():
        images = _list(path, COLOR_SUFFIXES)
        if not images:
            raise CalibrationError(f"{name}: {path} holds no images ({', '.join(COLOR_SUFFIXES)}) and is not a video.")
        return CameraSource(name, path, tuple(images), fps or 0.0, len(images))
    told, promised = VideoFile(path.parent, path.name).read_header()
    return CameraSource(name, path, (), told or fps or USUAL_FPS, promised)


def _list(folder: Path, suffixes: tuple[str, ...]) -> list[str]:
    names = (entry.name for entry in folder.iterdir() if entry.is_file() and not entry.name.startswith("."))
    return sort_naturally(name for name in names if name.lower().endswith(suffixes))
