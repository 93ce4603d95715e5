"""How large the scans in some files are, told before anything is stored."""

from __future__ import annotations

import base64
from pathlib import Path

import numpy as np

from server.scans.folder import find_scans
from server.scans.schemas import ScanMeasure, ScanRefusal, ScansMeasured
from server.scans.thumbnails import draw_picture
from server.storage.digest import compute_digest

PICTURE_PX = 160


def measure_scans(folder: Path) -> ScansMeasured:
    """The size of every scan that a folder holds, in the unit of its file."""
    from tracker import TrackerError
    from tracker.capture import HAND_LENGTHS, LONGEST_SCENE

    found = find_scans(folder)
    measured, refused = [], []
    for name, path in found.scans.items():
        line = found.listed.get(name)
        try:
            measured.append(_measure(name, path, line.metres_per_unit if line else None))
        except TrackerError as fault:
            refused.append(ScanRefusal(file=name, detail=found.hide_root(str(fault))))
    return ScansMeasured(
        files=measured,
        refused=refused,
        notes=found.write_notes(),
        hand_lengths_m=list(HAND_LENGTHS),
        longest_scene_m=LONGEST_SCENE,
    )


def _measure(name: str, path: Path, listed: float | None) -> ScanMeasure:
    from tracker import read_scan
    from tracker.capture import find_possible_units, is_certain, measure_size

    scan = read_scan(path)
    size = measure_size(scan.points)
    possible = find_possible_units(float(size[0]))
    picture, side = draw_picture(scan, np.ones(len(scan.points), dtype=np.bool_), compute_digest(path), PICTURE_PX)
    return ScanMeasure(
        file=name,
        point_count=len(scan.points),
        size_units=[float(length) for length in size],
        metres_per_unit=listed,
        guess=next(iter(possible.values()), None),
        is_certain=is_certain(float(size[0])),
        picture=f"data:image/png;base64,{base64.b64encode(picture).decode()}",
        picture_units=side,
    )
