"""Small pictures of what an import would store."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import numpy.typing as npt

from server.errors import NotFoundError
from server.sequences.depth_colors import index_depth, load_palette
from tracker import FrameError
from tracker.capture import read_import_picture
from tracker.evaluation import encode_jpeg

WIDTH = 320


def make_picture(source: Path, name: str) -> bytes:
    """A JPEG of an image in an upload; depth from near (bright) to far (dark), no value black."""
    try:
        image = read_import_picture(source, name)
    except FrameError as fault:
        raise NotFoundError(str(fault)) from None
    pixels = _color_depth(image.astype(np.uint16)) if image.ndim == 2 else image.astype(np.uint8)
    height, width = pixels.shape[:2]
    if width > WIDTH:
        size = (WIDTH, max(1, round(height * WIDTH / width)))
        pixels = cv2.resize(pixels, size, interpolation=cv2.INTER_AREA).astype(np.uint8)
    return encode_jpeg(pixels)


def _color_depth(raw: npt.NDArray[np.uint16]) -> npt.NDArray[np.uint8]:
    values = raw[raw > 0]
    near, far = np.percentile(values, (1, 99)) if values.size else (0.0, 1.0)
    return load_palette("viridis")[index_depth(raw, 1.0, float(near), max(float(far), float(near) + 1))]
