"""Points, colours and triangles of Wavefront OBJ files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt

from tracker.capture.scan_values import MAX_FILE_FACES, MAX_FILE_POINTS, RawScan, to_bytes_of_color
from tracker.errors import ScanError

NEEDED = "an OBJ with lines 'v x y z' (perhaps with r g b) and 'f a b c'"


def read_obj_scan(path: Path, data: bytes) -> RawScan:
    """Read positions, colours behind them, and faces (polygons as fans). Normals, textures and materials are left."""
    values: list[bytes] = []
    triangles: list[npt.NDArray[np.int64]] = []
    corners: list[bytes] = []
    for line in data.splitlines():
        if line[:2] in (b"v ", b"v\t"):
            values.append(line[2:])
        elif line[:2] in (b"f ", b"f\t"):
            corners.append(line[2:])
    if len(values) > MAX_FILE_POINTS or len(corners) > MAX_FILE_FACES:
        raise ScanError(path, f"{len(values)} points and {len(corners)} faces", f"at most {MAX_FILE_POINTS}")
    if not values:
        raise ScanError(path, "no line 'v x y z'", NEEDED)
    rows = _read_rows(path, values)
    for start in range(0, len(corners), 100_000):
        triangles.append(_read_faces(path, corners[start : start + 100_000], len(rows)))
    faces = np.concatenate(triangles) if triangles else None
    return RawScan(rows[:, :3], faces, None, to_bytes_of_color(rows[:, 3:6]) if rows.shape[1] >= 6 else None)


def _read_rows(path: Path, lines: list[bytes]) -> npt.NDArray[np.float64]:
    width = len(lines[0].split())
    try:
        rows = np.array(b" ".join(lines).split(), dtype=np.bytes_).astype(np.float64)
    except ValueError as error:
        raise ScanError(path, f"a coordinate that is not a number ({str(error)[:60]})", NEEDED) from error
    if width < 3 or len(rows) != width * len(lines):
        raise ScanError(path, "points with different numbers of values", NEEDED)
    return rows.reshape(-1, width)


def _read_faces(path: Path, lines: list[bytes], num_points: int) -> npt.NDArray[np.int64]:
    triangles: list[tuple[int, int, int]] = []
    try:
        for line in lines:
            ids = [int(corner.split(b"/", 1)[0]) for corner in line.split()]
            ids = [i - 1 if i > 0 else i + num_points for i in ids]
            triangles.extend((ids[0], ids[k], ids[k + 1]) for k in range(1, len(ids) - 1))
    except ValueError as error:
        raise ScanError(path, f"a face that cannot be read ({str(error)[:60]})", NEEDED) from error
    faces = np.array(triangles, dtype=np.int64).reshape(-1, 3)
    if len(faces) and (faces.min() < 0 or faces.max() >= num_points):
        raise ScanError(path, f"a face with the point {faces.max() + 1}", f"points 1 to {num_points}")
    return faces
