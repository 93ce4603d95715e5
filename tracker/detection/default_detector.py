"""The fingertip detector that comes with Handloom; `scripts/build_detector.py` made it from renders."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from tracker.detection.forest import Forest
from tracker.detection.forest_files import load_forest

DATA = Path(__file__).parent / "data" / "fingertips_depth.npz"


@cache
def default_detector() -> Forest:
    """Finds fingertips in depth images."""
    return load_forest(DATA)
