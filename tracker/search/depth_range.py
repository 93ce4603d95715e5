"""The depth range in which hands are looked for, [T16] §3.2.1."""

from __future__ import annotations

import numpy as np

from tracker.capture.frame import Frame


def depth_range(frame: Frame) -> tuple[float, float]:
    """A depth range, m, for a frame about which nothing is known: to 0.6 m behind the nearest thing of some size."""
    assert frame.depth is not None
    values = frame.depth[(frame.depth > 0.1) & (frame.depth < 3.0)]
    if values.size < 200:
        return 0.1, 3.0
    nearest = float(np.partition(values, 200)[200])
    return 0.1, nearest + 0.6
