"""Named arrays in one npz file, written whole or not at all and with the same bytes for the same arrays."""

from __future__ import annotations

import io
import os
import zipfile
from pathlib import Path

import numpy as np

from tracker.errors import TrackingError, reading


def save_arrays(path: Path, arrays: dict[str, np.ndarray]) -> None:
    """Write arrays to `path` by way of a temporary sibling. Equal arrays give equal bytes: no times are stored."""
    path = Path(path)
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, array in arrays.items():
            entry = zipfile.ZipInfo(f"{name}.npy", date_time=(1980, 1, 1, 0, 0, 0))
            entry.compress_type = zipfile.ZIP_DEFLATED
            content = io.BytesIO()
            np.lib.format.write_array(content, np.asarray(array, order="C"), allow_pickle=False)
            archive.writestr(entry, content.getvalue(), compresslevel=1)
    temporary = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        with temporary.open("wb") as file:
            file.write(buffer.getvalue())
            file.flush()
            os.fsync(file.fileno())
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)


def load_arrays(path: Path, names: tuple[str, ...], optional: tuple[str, ...] = ()) -> dict[str, np.ndarray]:
    """Read the named arrays of an npz file, and those of the optional ones that it has; no pickles.

    Raises:
        TrackingError: The file is missing, damaged or lacks an array.
    """
    with (
        reading(TrackingError, path, "an npz file as tracking writes it"),
        np.load(path, allow_pickle=False) as archive,
    ):
        missing = [name for name in names if name not in archive]
        if missing:
            raise TrackingError(f"{path}: has no {', '.join(missing)}; needed {', '.join(names)}.")
        return {name: archive[name] for name in (*names, *(name for name in optional if name in archive))}
