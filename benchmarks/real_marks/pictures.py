"""Marked frames with the hand that was found drawn over them, to look at."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import cv2
import numpy as np
import numpy.typing as npt

from benchmarks.real_marks.marked import MarkedRecording
from tracker.capture.sequence import Sequence
from tracker.model.joints import HAND_EDGES

COLORS = ((80, 80, 255), (80, 255, 80), (255, 160, 80), (80, 255, 255), (255, 80, 255))
"""Blue green red, of thumb, index, middle, ring and little finger."""

SIDE, MARGIN, COLUMNS = 420, 15, 4
"""px of a picture's side and of the image around the hand; pictures in a row."""


def draw_frames(
    sequence: Sequence, recording: MarkedRecording, joints: Mapping[int, npt.NDArray], lost: set[int], path: Path
) -> None:
    """A sheet of all marked frames: bones in their fingers' colours, marks as crosses, lost frames named so."""
    pictures = [
        _draw(
            sequence.frame(frame, sequence.cameras[0].id).color,
            joints[frame],
            marks,
            f"{frame}" + " lost" * (frame in lost),
        )
        for frame, marks in recording.marks.items()
        if frame in joints
    ]
    while len(pictures) % COLUMNS:
        pictures.append(np.zeros((SIDE, SIDE, 3), dtype=np.uint8))
    rows = [np.hstack(pictures[first : first + COLUMNS]) for first in range(0, len(pictures), COLUMNS)]
    cv2.imwrite(str(path), np.vstack(rows))


def _draw(color: npt.NDArray | None, joints: npt.NDArray, marks: npt.NDArray, title: str) -> npt.NDArray[np.uint8]:
    assert color is not None
    shown = np.vstack([joints, marks[~np.isnan(marks[:, 0])]])
    low = np.maximum(shown.min(axis=0) - MARGIN, 0).astype(int)
    high = np.minimum(shown.max(axis=0) + MARGIN, color.shape[1::-1]).astype(int)
    scale = SIDE / float(max(1, *(high - low)))
    part = np.ascontiguousarray(color[low[1] : high[1], low[0] : high[0], ::-1])
    if not part.size:
        return np.zeros((SIDE, SIDE, 3), dtype=np.uint8)
    image = cv2.resize(part, None, fx=scale, fy=scale, interpolation=cv2.INTER_CUBIC)

    def place(point: npt.NDArray) -> tuple[int, int]:
        column, row = (point + 0.5 - low) * scale
        return int(column), int(row)

    for first, second in HAND_EDGES:
        cv2.line(image, place(joints[first]), place(joints[second]), COLORS[(second - 1) // 4], 2, cv2.LINE_AA)
    for joint in np.flatnonzero(~np.isnan(marks[:, 0])):
        cv2.drawMarker(image, place(marks[joint]), (0, 0, 0), cv2.MARKER_CROSS, 15, 4)
        cv2.drawMarker(image, place(marks[joint]), COLORS[max(0, joint - 1) // 4], cv2.MARKER_CROSS, 13, 2)
    cv2.putText(image, title, (6, 16), cv2.FONT_HERSHEY_SIMPLEX, 0.5, (255, 255, 255), 1, cv2.LINE_AA)
    full = np.zeros((SIDE, SIDE, 3), dtype=np.uint8)
    full[: image.shape[0], : image.shape[1]] = image[:SIDE, :SIDE]
    return full
