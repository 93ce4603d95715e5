"""Files of a moving scan's frames: read in the process that computes, and made ready to be played."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from server.compute import ComputeContext
from server.scans.geometry import choose_points, pack_scan
from server.scans.thumbnails import SIZE_PX, draw_picture
from server.storage.digest import compute_digest

if TYPE_CHECKING:
    from tracker import Scan

VIEW_POINTS = 20_000
"""Points of a frame that the browser draws."""
THUMBNAIL = "thumbnail.png"
CLEARLY = 1.2
"""A person stands along z where the scan is so many times as long along it as along y."""


@dataclass(frozen=True)
class FrameRead:
    """What one file holds.

    Attributes:
        digest: SHA-256 of the file.
        point_count: 0 when it cannot be used.
        metres_per_unit: As said, or as the size tells; None when it cannot be used.
        low: Lowest x, y, z of its points, m.
        high: Highest ones.
        problem: Why it cannot be used, a sentence.
    """

    digest: str
    point_count: int = 0
    metres_per_unit: float | None = None
    low: tuple[float, ...] = ()
    high: tuple[float, ...] = ()
    problem: str | None = None


def find_view(folder: Path, frame: int) -> Path:
    """The file with a frame's points for the browser."""
    return folder / f"{frame:06d}.view"


def read_frames(
    _context: ComputeContext, folder: Path, files: list[tuple[int, str]], metres_per_unit: float | None
) -> list[FrameRead]:
    """Read some frames and write their points for the browser beside them.

    Args:
        folder: Where the files are, named by the studio.
        files: Number and file of each frame.
        metres_per_unit: Of all of them; left out, the first that can be read tells it.
    """
    found: list[FrameRead] = []
    for frame, file in files:
        read = _read_one(folder, frame, file, metres_per_unit)
        metres_per_unit = metres_per_unit or read.metres_per_unit
        found.append(read)
    return found


def _read_one(folder: Path, frame: int, file: str, metres_per_unit: float | None) -> FrameRead:
    from tracker import TrackerError, read_scan
    from tracker.bodies import find_body_unit

    path = folder / file
    digest = compute_digest(path)
    try:
        scan = read_scan(path)
        unit = find_body_unit(path, scan, metres_per_unit)
    except TrackerError as fault:
        return FrameRead(digest, problem=str(fault).replace(f"{path}: ", ""))
    scan = scan.scaled(unit)
    flags = np.zeros(len(scan.points), dtype=np.uint8)
    view = pack_scan(scan.points, scan.normals, scan.colors, flags, VIEW_POINTS, digest)
    find_view(folder, frame).write_bytes(view)
    if not (folder / THUMBNAIL).exists():
        picture, _ = draw_picture(scan, flags == 0, digest, SIZE_PX, find_standing(scan.points))
        (folder / THUMBNAIL).write_bytes(picture)
    low, high = scan.points.min(axis=0).tolist(), scan.points.max(axis=0).tolist()
    return FrameRead(digest, len(scan.points), unit, tuple(low), tuple(high))


def choose_view_points(scan: Scan, digest: str) -> np.ndarray:
    """Indices of the points of a scan that its view has; `digest` is that of its file."""
    return choose_points(len(scan.points), VIEW_POINTS, digest)


def find_standing(points: np.ndarray) -> np.ndarray:
    """(3, 3) rotation whose rows are right, up, towards the eye, of a person (N, 3): y is up, or z where the person is
    clearly longer along it; the broad side looks at the eye. As the browser has it in `standing.ts`."""
    size = np.ptp(points, axis=0)
    up = np.eye(3)[2 if size[2] > CLEARLY * size[1] else 1]
    flat = points - points.mean(axis=0)
    flat = flat - np.outer(flat @ up, up)
    right = np.linalg.eigh(flat.T @ flat)[1][:, 2]
    right = right if right[0] >= 0.0 else -right
    return np.stack([right, up, np.cross(right, up)])
