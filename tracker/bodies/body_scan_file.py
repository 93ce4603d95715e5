"""A scan of a person from a file: read as scans of hands are, with a person's size to tell the unit."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tracker.capture.scan import Scan, read_scan
from tracker.capture.scan_size import UNITS, measure_size, write_length
from tracker.errors import ScanError

BODY_LENGTHS = (0.9, 2.6)
"""m; longest side of a scan of a person: somebody seated at least, a tall person with raised arms at most."""

NEEDED = f"one whole person of {BODY_LENGTHS[0]:g} to {BODY_LENGTHS[1]:g} m"


def load_body_scan(path: Path, metres_per_unit: float | None = None) -> tuple[Scan, bool]:
    """A scan in metres, and whether its unit was guessed from its size.

    Args:
        path: PLY, OBJ, STL or npz.
        metres_per_unit: Length of the file's unit, if known.

    Raises:
        ScanError: No scan, or of a size that no person has; names the file.
    """
    scan = read_scan(path)
    return scan.scaled(find_body_unit(path, scan, metres_per_unit)), metres_per_unit is None


def find_body_unit(path: Path, scan: Scan, metres_per_unit: float | None = None) -> float:
    """Metres per unit of a scan of a person: as somebody says, or the only one that a person's size leaves.

    Args:
        path: For the message.
        scan: In the unit of its file.
        metres_per_unit: As somebody says.

    Raises:
        ScanError: The scan has a size that no person has, or a size that leaves the unit open.
    """
    length = float(measure_size(scan.points)[0])
    if metres_per_unit is not None:
        if not (np.isfinite(metres_per_unit) and metres_per_unit > 0.0):
            raise ScanError(path, f"a unit of {metres_per_unit} m", "a positive number of metres")
        if not BODY_LENGTHS[0] <= length * metres_per_unit <= BODY_LENGTHS[1]:
            found = f"a scan {write_length(length * metres_per_unit)} long with 1 unit = {1e3 * metres_per_unit:.6g} mm"
            raise ScanError(path, found, f"{NEEDED}; correct its unit (metres per unit) or crop it")
        return metres_per_unit
    possible = {name: metres for name, metres in UNITS.items() if BODY_LENGTHS[0] <= length * metres <= BODY_LENGTHS[1]}
    if len(possible) != 1:
        lengths = " or ".join(f"{write_length(length * metres)} in {name}" for name, metres in possible.items())
        found = f"a size of {length:.4g} units (longest side)" + (f", which may be {lengths}" if lengths else "")
        raise ScanError(path, found, f"{NEEDED}, in m, cm, mm or inches; say its unit (metres per unit) or crop it")
    return next(iter(possible.values()))
