"""Named arrays in one npz file, written whole or not at all and with the same bytes for the same arrays."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tracker.capture.atomic_file import write_atomically
from tracker.errors import TrackingError, reading
from tracker.model.npz_files import pack_npz


def save_arrays(path: Path, arrays: dict[str, np.ndarray]) -> None:
    """Write arrays to `path` by way of a temporary sibling. Equal arrays give equal bytes: no times are stored."""
    write_atomically(Path(path), pack_npz(arrays))


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
