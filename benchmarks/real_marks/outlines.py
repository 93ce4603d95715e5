"""How far a tracked hand covers the hand that was outlined by eye in an image."""

from __future__ import annotations

import json

import cv2
import numpy as np
import numpy.typing as npt

from benchmarks.real_marks.marked import FOLDER
from tracker.capture.camera import Camera
from tracker.capture.sequence import Sequence
from tracker.rendering import render_view
from tracker.tracking.track import Track

Mask = npt.NDArray[np.bool_]
Array = npt.NDArray[np.float64]

OUTLINES = "outlines.json"
"""Beside the marks: of each outlined frame (N, 2) px around the hand; from the last to the first across the wrist."""


def measure_overlaps(sequence: Sequence, track: Track, camera_id: str) -> Array:
    """(F,) intersection over union of the drawn hand and the outlined one, of each outlined frame; 0 where it is lost.

    What is drawn of the forearm does not count.
    """
    path = FOLDER / f"{sequence.name}_{camera_id}" / OUTLINES
    if not path.exists():
        return np.zeros(0)
    camera = sequence.camera(camera_id)
    overlaps = []
    for frame, outline in json.loads(path.read_text()).items():
        row = int(np.flatnonzero(track.frame == int(frame))[0])
        is_lost = track.status[row] == "lost"
        drawn = np.zeros((camera.height, camera.width), dtype=bool) if is_lost else draw_hand(track, row, camera)
        overlaps.append(compare_outline(drawn, np.array(outline, dtype=np.float64)))
    return np.array(overlaps)


def draw_hand(track: Track, row: int, camera: Camera) -> Mask:
    """(H, W) where the image of an ideal lens shows the tracked hand."""
    posed = track.setup.scene.pose_at(track.pose[row])
    return render_view(posed, camera.K, camera.T_world_camera, camera.height, camera.width).face >= 0


def compare_outline(drawn: Mask, outline: Array) -> float:
    """Intersection over union of a drawn hand (H, W) and an outline (N, 2) px, on the hand's side of the wrist."""
    seen = np.zeros(drawn.shape, dtype=np.uint8)
    cv2.fillPoly(seen, [np.rint(outline).astype(np.int32)], 1)
    (x, y), (u, v) = outline[0], outline[-1] - outline[0]
    rows, columns = np.indices(drawn.shape)
    side = u * (rows - y) - v * (columns - x)
    is_beyond = side * np.median(u * (outline[:, 1] - y) - v * (outline[:, 0] - x)) >= 0.0
    hand, outlined = drawn & is_beyond, (seen > 0) & is_beyond
    return float(np.count_nonzero(hand & outlined) / max(np.count_nonzero(hand | outlined), 1))
