"""Where each camera saw the board, frame by frame."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from tracker.calibration.board import Board, list_dictionaries
from tracker.calibration.camera_source import USUAL_FPS, CameraSource, Grey
from tracker.calibration.corner_detector import CornerDetector
from tracker.errors import CalibrationError, FrameError, say_count

Array = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]
Report = Callable[[str, float], None]
"""Told what is being done and how much of it, 0 to 1; what it raises ends the work."""

KEPT_PICTURES = 12
"""Of a camera that has not seen the board yet: looked at again, flipped and with other markers, to say why."""

MIN_SIGHTINGS = 4
"""Fewer do not tell a lens; Zhang's method needs three."""

USUAL_FAMILIES = "DICT_4X4_50", "DICT_5X5_100", "DICT_6X6_250", "DICT_7X7_250", "DICT_APRILTAG_36h11", "DICT_4X4_1000"


@dataclass(frozen=True, eq=False)
class Sightings:
    """What one camera saw of the board.

    Attributes:
        camera: Its name.
        width: px.
        height: px.
        fps: Frames a second.
        times: (F,) s since the camera's first frame, of every frame.
        frames: (S,) numbers of the frames in which the board was found, ascending.
        corners: (S, N, 2) px, NaN where a corner was not seen.
    """

    camera: str
    width: int
    height: int
    fps: float
    times: Array
    frames: Integers
    corners: Array

    def __post_init__(self) -> None:
        assert self.corners.ndim == 3 and self.corners.shape[::2] == (len(self.frames), 2)

    @property
    def seen_at(self) -> Array:
        """(S,) s since the camera's first frame."""
        return self.times[self.frames]


def find_sightings(source: CameraSource, board: Board, report: Report = lambda what, share: None) -> Sightings:
    """Look for the board in every frame of a camera.

    Args:
        source: The camera's pictures; read as a stream.
        board: The board.
        report: Called after every frame.

    Raises:
        CalibrationError: The board was not found in `MIN_SIGHTINGS` frames; says what was seen instead.
        FrameError: A frame cannot be decoded, or fewer come than the file promises.
    """
    detector = CornerDetector(board)
    times, frames, corners, kept = [], [], [], []
    shape: tuple[int, int] = (0, 0)
    every = max(1, source.promised // KEPT_PICTURES)
    for index, (time_s, image) in enumerate(source.read()):
        shape = (image.shape[0], image.shape[1])
        times.append(time_s)
        found = detector.find(image)
        if np.isfinite(found).any():
            frames.append(index)
            corners.append(found)
        if index % every == 0 and len(frames) < MIN_SIGHTINGS and len(kept) < KEPT_PICTURES:
            kept.append(image)
        report(f"looking for the board in {source.id}", min((index + 1) / max(source.promised, 1), 1.0))
    if len(times) < 0.98 * source.promised - 1:
        raise FrameError(
            f"{source.id}: stops in the middle: {say_count(len(times), 'frame')} of the {source.promised} that its "
            "header "
            "promises can be decoded. Copy it again, or leave this camera out."
        )
    if len(frames) < MIN_SIGHTINGS:
        raise CalibrationError(
            f"{source.id}: the board ({board.describe()}) was found in {len(frames)} of "
            f"{say_count(len(times), 'frame')}; "
            f"needed at least {MIN_SIGHTINGS}. {explain_absence(board, kept)}"
        )
    height, width = shape
    fps = source.fps or USUAL_FPS
    return Sightings(
        source.id, width, height, fps, _tidy_times(np.array(times), fps), np.array(frames), np.array(corners)
    )


def explain_absence(board: Board, images: list[Grey]) -> str:
    """A sentence: is the camera mirrored, are other markers there, is the board the other way round?"""
    detector = CornerDetector(board)
    if (
        board.kind != "checkerboard"
        and sum(np.isfinite(detector.find(np.ascontiguousarray(i[:, ::-1]))).any() for i in images) >= 1
    ):
        return (
            "In the mirrored picture it is found: this camera is mirrored. Switch its mirroring off, or flip the video."
        )
    shades = [255 - image for image in images]
    if sum(bool(np.isfinite(detector.find(image)).any()) for image in shades) >= 1:
        return "With black and white exchanged it is found: say inverted = true (or false) in the board's description."
    if board.kind == "checkerboard":
        return "A checkerboard must be seen whole; are its squares counted with the outer ones?"
    own = _count_markers(board.dictionary, images)
    if own:
        return (
            f"{say_count(own, 'marker')} of its family {'is' if own == 1 else 'are'} there, but not where this board "
            "has them: "
            "check columns, rows, and whether the pattern is a legacy one."
        )
    counts = {name: _count_markers(name, images + shades) for name in USUAL_FAMILIES if name in list_dictionaries()}
    best = max(counts, key=lambda name: counts[name])
    if counts[best] >= 3:
        return f"Markers of {best} are there: another board than the one described."
    return "No markers at all are there: is this the right video, sharp and bright enough, and the board near enough?"


def _count_markers(dictionary: str, images: list[Grey]) -> int:
    detector = cv2.aruco.ArucoDetector(cv2.aruco.getPredefinedDictionary(getattr(cv2.aruco, dictionary)))
    return sum(len(detector.detectMarkers(image)[0]) for image in images)


def _tidy_times(times: Array, fps: float) -> Array:
    """Times as the file has them if they ascend, counted from the first frame; else by the frame rate."""
    if len(times) > 1 and np.isfinite(times).all() and (np.diff(times) > 0.1 / fps).all():
        return times - times[0]
    return np.arange(len(times)) / fps
