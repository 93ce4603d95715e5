"""What is computed of scans: points for the browser, pictures for lists, what a crop or another unit leaves."""

from __future__ import annotations

from pathlib import Path

from server.compute import ComputeContext
from server.scans.models import ScanCropRow, ScanRow
from server.scans.schemas import ScanCrop, ScansMeasured
from server.scans.service import Kept, Scaled, ScanCache, judge_crop, scale_scan


def pack_scan(context: ComputeContext, row: ScanRow, crop: ScanCropRow | None, size: int) -> bytes:
    """A scan for the browser, as of a revision, with at most so many points."""
    return context.keep(ScanCache).pack(row, crop, size)


def draw_scan(context: ComputeContext, row: ScanRow, crop: ScanCropRow | None) -> bytes:
    """A small picture of what is left of a scan as of a revision."""
    return context.keep(ScanCache).draw(row, crop)


def crop_scan(context: ComputeContext, row: ScanRow, crop: ScanCrop) -> Kept:
    """What a crop leaves; raises when that is too little."""
    return judge_crop(context.keep(ScanCache).get(row), crop)


def give_unit(context: ComputeContext, row: ScanRow, crop: ScanCropRow | None, metres_per_unit: float) -> Scaled:
    """A scan in another unit; raises when it has a size then that no scan has."""
    return scale_scan(context.keep(ScanCache).get(row), row, crop, metres_per_unit)


def measure_folder(_context: ComputeContext, folder: Path) -> ScansMeasured:
    """How large the scans of a folder would be, in which units."""
    from server.scans.measuring import measure_scans

    return measure_scans(folder)
