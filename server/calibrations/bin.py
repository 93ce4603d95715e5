"""Camera calibrations in the bin."""

from __future__ import annotations

from server.bin.kinds import make_kind
from server.calibrations.models import CalibrationRow
from server.calibrations.storing import AREA

CALIBRATIONS = make_kind("calibration", "camera calibration", CalibrationRow, AREA)
"""The table of camera calibrations."""
