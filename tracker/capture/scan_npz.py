"""Scans as npz: `points`, and perhaps `normals`, `faces`, `colors`."""

from __future__ import annotations

import io
import zipfile
from pathlib import Path

import numpy as np
import numpy.typing as npt

from tracker.capture.scan_values import MAX_FILE_BYTES, MAX_FILE_FACES, MAX_FILE_POINTS, RawScan, to_bytes_of_color
from tracker.errors import ScanError, reading

NEEDED = "an npz with points (N, 3), and perhaps normals (N, 3), faces (F, 3), colors (N, 3)"


def read_npz_scan(path: Path, data: bytes) -> RawScan:
    """Read the arrays; no pickles, and nothing that unpacks to more than MAX_FILE_BYTES."""
    found = _load_arrays(path, data)
    _check_arrays(path, found)
    return RawScan(
        points=found["points"].astype(np.float64),
        faces=found["faces"].astype(np.int64) if "faces" in found else None,
        normals=found["normals"].astype(np.float64) if "normals" in found else None,
        colors=to_bytes_of_color(found["colors"]) if "colors" in found else None,
    )


def _load_arrays(path: Path, data: bytes) -> dict[str, npt.NDArray]:
    with reading(ScanError, path, NEEDED):
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            unpacked = sum(entry.file_size for entry in archive.infolist())
        if unpacked > MAX_FILE_BYTES:
            raise ScanError(path, f"{unpacked} bytes when unpacked", f"at most {MAX_FILE_BYTES}")
        with np.load(io.BytesIO(data), allow_pickle=False) as arrays:
            return {name: arrays[name] for name in ("points", "normals", "faces", "colors") if name in arrays}


def _check_arrays(path: Path, found: dict[str, npt.NDArray]) -> None:
    if "points" not in found:
        raise ScanError(path, "an npz without points", NEEDED)
    for name, array in found.items():
        if array.ndim != 2 or array.shape[1] != 3 or array.dtype.kind not in ("ui" if name == "faces" else "fui"):
            raise ScanError(path, f"{name} of shape {array.shape} and kind {array.dtype}", NEEDED)
        if name in ("normals", "colors") and len(array) != len(found["points"]):
            raise ScanError(path, f"{len(array)} {name} for {len(found['points'])} points", NEEDED)
    if len(found["points"]) > MAX_FILE_POINTS or len(found.get("faces", ())) > MAX_FILE_FACES:
        raise ScanError(path, f"{len(found['points'])} points", f"at most {MAX_FILE_POINTS}")


def pack_npz_scan(
    points: npt.NDArray[np.float64],
    normals: npt.NDArray[np.float64],
    faces: npt.NDArray[np.int64] | None,
    colors: npt.NDArray[np.uint8] | None,
) -> bytes:
    """The bytes of such a file."""
    arrays: dict[str, npt.NDArray] = {"points": points, "normals": normals}
    if faces is not None:
        arrays["faces"] = faces
    if colors is not None:
        arrays["colors"] = colors
    buffer = io.BytesIO()
    np.savez_compressed(buffer, allow_pickle=False, **arrays)
    return buffer.getvalue()
