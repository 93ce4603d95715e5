"""Triangles of STL files, binary or ASCII."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tracker.capture.scan_values import MAX_FILE_FACES, RawScan
from tracker.errors import ScanError

NEEDED = "an STL of triangles: a header of 80 bytes, their number and 50 bytes each; or ASCII from 'solid' on"

RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("extra", "<u2")])


def read_stl_scan(path: Path, data: bytes) -> RawScan:
    """Read the triangles; every triangle brings its own three points."""
    count = int.from_bytes(data[80:84], "little") if len(data) >= 84 else -1
    if count >= 0 and len(data) == 84 + RECORD.itemsize * count:
        if not 0 < count <= MAX_FILE_FACES:
            raise ScanError(path, f"{count} triangles", f"1 to {MAX_FILE_FACES}")
        corners = np.frombuffer(data, RECORD, count, 84)["corners"].astype(np.float64)
    elif data.lstrip()[:5].lower() == b"solid":
        corners = _read_ascii(path, data)
    else:
        raise ScanError(path, f"{len(data)} bytes, of which the header promises {count} triangles", NEEDED)
    return RawScan(corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3))


def _read_ascii(path: Path, data: bytes) -> np.ndarray:
    lines = [line.split()[1:4] for line in data.split(b"\n") if line.lstrip().startswith(b"vertex")]
    if not lines or len(lines) % 3 or any(len(line) != 3 for line in lines):
        raise ScanError(path, f"{len(lines)} lines of vertices", NEEDED)
    try:
        return np.array(lines).astype(np.float64).reshape(-1, 3, 3)
    except ValueError as error:
        raise ScanError(path, f"a vertex that is not a number ({error})", NEEDED) from error
