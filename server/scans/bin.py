"""Scans in the bin."""

from __future__ import annotations

from server.bin.kinds import make_kind
from server.scans.models import ScanRow
from server.scans.service import AREA

SCANS = make_kind("scan", "scan", ScanRow, AREA)
