"""Small recordings for the tests of this room."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import pytest

from tracker.capture import RecordedCamera, Sequence, parse_pattern, save_sequence_json

WIDTH, HEIGHT = 64, 48


def draw_color(index: int) -> np.ndarray:
    """(48, 64, 3) uint8 RGB, different for each frame."""
    image = np.zeros((HEIGHT, WIDTH, 3), np.uint8)
    image[..., 0] = 200
    image[..., 1] = np.arange(WIDTH)
    image[..., 2] = index
    return image


def draw_depth(index: int) -> np.ndarray:
    """(48, 64) uint16 mm: a plate at 0.5 m before nothing."""
    image = np.zeros((HEIGHT, WIDTH), np.uint16)
    image[10:40, 10:50] = 500 + index
    return image


def write_png(path: Path, image: np.ndarray) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    pixels = image[..., ::-1] if image.ndim == 3 else image
    path.write_bytes(cv2.imencode(".png", np.ascontiguousarray(pixels))[1].tobytes())
    return path


def write_recording(folder: Path, frames: int = 5) -> Path:
    """A recording folder in our own format: one RGB-D camera."""
    folder.mkdir(parents=True, exist_ok=True)
    camera = RecordedCamera(
        "cam0",
        WIDTH,
        HEIGHT,
        np.array([[60.0, 0, 31.5], [0, 60.0, 23.5], [0, 0, 1]]),
        color=parse_pattern("color/{:06d}.png"),
        depth=parse_pattern("depth/{:06d}.png"),
        depth_scale=0.001,
    )
    save_sequence_json(Sequence(folder, "plate", 30.0, frames, (camera,), ("right",)))
    for i in range(frames):
        write_png(folder / f"color/{i:06d}.png", draw_color(i))
        write_png(folder / f"depth/{i:06d}.png", draw_depth(i))
    return folder


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    return write_recording(tmp_path / "plate")


@pytest.fixture
def make_recording() -> Callable[..., Path]:
    return write_recording


@pytest.fixture
def save_png() -> Callable[[Path, np.ndarray], Path]:
    return write_png
