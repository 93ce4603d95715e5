"""Fingertip detectors in the bin."""

from __future__ import annotations

from server.bin.kinds import make_kind
from server.detectors.models import DetectorRow
from server.detectors.service import AREA

DETECTORS = make_kind("detector", "fingertip detector", DetectorRow, AREA)
"""The table of fingertip detectors that were uploaded."""
