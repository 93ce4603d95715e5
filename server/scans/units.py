"""The unit of a scan's file: what size it makes of the scan, and what else changes when somebody corrects it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from server.errors import InvalidError
from server.scans.models import ScanCropRow, ScanRow
from server.scans.schemas import PlaneStroke, Stroke

if TYPE_CHECKING:
    from tracker import Scan


def measure_kept(scan: Scan, flags: np.ndarray) -> list[float]:
    """Sides of a box that stands along the points that are kept, m, the longest first."""
    from tracker.capture import measure_size

    kept = scan.points[flags == 0]
    return [float(side) for side in measure_size(kept if len(kept) else scan.points)]


def find_revision_unit(row: ScanRow, crop: ScanCropRow | None) -> float | None:
    """Metres per unit as of a revision; None for what was added before migration 0012 and never corrected."""
    return row.first_metres_per_unit if crop is None or crop.metres_per_unit is None else crop.metres_per_unit


def find_old_unit(row: ScanRow, scan: Scan) -> float:
    """The unit that an earlier version found for a scan: a power of ten, told by the extent that it stored.

    Args:
        row: Of a scan added before migration 0012.
        scan: In the unit of its file.
    """
    extent = float((scan.points.max(axis=0) - scan.points.min(axis=0)).max())
    return 10.0 ** round(math.log10(max(row.extent_m) / extent))


def check_size(length_m: float, metres_per_unit: float) -> None:
    """Raise when a unit makes a scan too small or too large to hold a hand."""
    from tracker.capture import LONGEST_SCENE, SIZES_NEEDED, find_size_fault

    if fault := find_size_fault(length_m, LONGEST_SCENE):
        raise InvalidError(
            f"With 1 unit = {1e3 * metres_per_unit:.6g} mm the scan {fault}; needed {SIZES_NEEDED}. Nothing was "
            "changed; give another unit."
        )


def find_rows_out_of_size(rows: Sequence[ScanRow]) -> dict[str, str]:
    """By name, what is wrong with the size of scans that are no hands as they are cropped now."""
    from tracker.capture import find_size_fault

    faults = {row.name: find_size_fault(max(row.size_m or row.extent_m)) for row in rows}
    return {name: fault for name, fault in faults.items() if fault is not None}


def scale_strokes(strokes: Sequence[Stroke], factor: float) -> list[Stroke]:
    """The strokes of a crop for the scan scaled by a factor: they take the same points."""
    scaled: list[Stroke] = []
    for stroke in strokes:
        if isinstance(stroke, PlaneStroke):
            scaled.append(stroke.model_copy(update={"offset": stroke.offset * factor}))
        else:
            view = np.array(stroke.view).reshape(4, 4)
            view[:, :3] /= factor
            scaled.append(stroke.model_copy(update={"view": view.ravel().tolist()}))
    return scaled
