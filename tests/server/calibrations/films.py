"""Small films of a waved board, rendered once for a run, and how they are sent."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import cv2
import numpy as np

from tests.tracker.calibration.filmed_board import Filmed, film
from tracker.calibration.board import Board

OFFSET_S = 0.13
BOARD = {"kind": "charuco", "columns": 5, "rows": 4, "square_mm": 60.0, "marker_mm": 45.0, "dictionary": "DICT_4X4_50"}
OPTIONS = {"board": BOARD, "max_offset_s": 1.0}


@cache
def filmed() -> Filmed:
    """Two cameras, the second one out of step by `OFFSET_S`."""
    board = Board("charuco", 5, 4, 0.06, 0.045, "DICT_4X4_50")
    return film(2, (0.0, OFFSET_S), fps=10.0, seconds=6.0, size=(480, 360), spread=0.6, board=board)


@cache
def render_films() -> dict[str, bytes]:
    """A video of each camera, by file name."""
    scene = filmed()
    with TemporaryDirectory() as folder:
        videos = {}
        for number, camera in enumerate(scene.cameras):
            path = Path(folder) / f"{camera.id}.avi"
            images = [scene.render(number, frame) for frame in range(len(scene.times(number)))]
            write_video(path, images)
            videos[path.name] = path.read_bytes()
        return videos


def write_video(path: Path, images: list[np.ndarray], fps: float = 10.0) -> None:
    """A video of grey pictures."""
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"MJPG"), fps, images[0].shape[::-1])
    for image in images:
        writer.write(cv2.cvtColor(image, cv2.COLOR_GRAY2BGR))
    writer.release()


def make_form(files: dict[str, bytes], name: str = "Rig", **options: Any) -> dict[str, Any]:
    """What a request sends."""
    data = {"name": name, "options": json.dumps({**OPTIONS, **options})}
    return {"files": [("files", (path, data)) for path, data in files.items()], "data": data}


def write_images(folder: Path, count: int, size: tuple[int, int] = (32, 24)) -> None:
    """A folder of small grey pictures, `size` wide and high, each of another grey."""
    folder.mkdir(parents=True)
    for number in range(count):
        cv2.imwrite(str(folder / f"{number}.png"), np.full(size[::-1], number, np.uint8))
