"""What a reader finds in a scan file, before anything is checked beyond the format."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

MAX_FILE_BYTES = 1 << 30
"""A bound of ours, as the two below."""
MAX_FILE_POINTS = 20_000_000
MAX_FILE_FACES = 40_000_000


class RawScan(NamedTuple):
    """points (N, 3) in the file's unit, faces (F, 3) or None, normals (N, 3) or None, colors (N, 3) uint8 or None."""

    points: npt.NDArray[np.float64]
    faces: npt.NDArray[np.int64] | None = None
    normals: npt.NDArray[np.float64] | None = None
    colors: npt.NDArray[np.uint8] | None = None

    def take(self, kept: npt.NDArray[Any], faces: npt.NDArray[np.int64] | None) -> RawScan:
        """Only the points of a mask (N,) or of indices, with triangles that are of them."""
        normals = None if self.normals is None else self.normals[kept]
        colors = None if self.colors is None else self.colors[kept]
        return RawScan(self.points[kept], faces, normals, colors)


def to_bytes_of_color(colors: npt.NDArray) -> npt.NDArray[np.uint8]:
    """(N, 3) colours as bytes: floats are shares of 1, unless some are above 1; wider integers are 16 bit."""
    if colors.dtype.kind == "f":
        finite = np.nan_to_num(colors, nan=0.0, posinf=0.0, neginf=0.0)
        scale = 255.0 if finite.max(initial=0.0) <= 1.0 else 1.0
        return np.clip(np.rint(finite * scale), 0, 255).astype(np.uint8)
    if colors.dtype.itemsize == 2:
        return (np.clip(colors, 0, 65535) >> 8).astype(np.uint8)
    return np.clip(colors, 0, 255).astype(np.uint8)
