"""How near and how far a depth camera sees, for pictures of depth that don't flicker from frame to frame."""

from __future__ import annotations

import numpy as np

from tracker import Sequence, TrackerError

SAMPLES = 8
"""Frames that are looked at, evenly over the recording."""


def measure_depth_range(recording: Sequence, camera_id: str) -> tuple[float, float]:
    """Near and far in m: 1st and 99th percentile of the depth values of some frames; 0.2 and 1.5 m without any."""
    scale = recording.camera(camera_id).depth_scale
    found = []
    for index in np.unique(np.linspace(0, recording.frame_count - 1, SAMPLES).astype(int)):
        try:
            raw = recording.depth_raw(int(index), camera_id)
        except TrackerError:
            continue
        found.append(raw[raw > 0])
    values = np.concatenate(found) if found else np.zeros(0, np.uint16)
    if values.size == 0:
        return 0.2, 1.5
    near, far = (float(value) * scale for value in np.percentile(values, (1, 99)))
    return round(near, 4), round(max(far, near + 0.01), 4)
