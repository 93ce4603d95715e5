"""What is wrong with what the cameras saw, camera by camera, in sentences."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tracker.calibration.camera_calibration import BoardResiduals, CameraCalibration, TimeOffset
from tracker.calibration.sightings import Sightings
from tracker.errors import CalibrationError, say_count

STOPS = 0.5
"""Of the longest video: a shorter one is no recording of the same, but of a camera that stopped."""

FRAMES_APART = 1.5
"""Lengths of videos that differ by more, in frames, were begun or ended at different times."""

BAD_PX = 1.0
"""Residual at the median above which a camera is named; corners are found to a quarter of that."""

OUT_OF_STEP = 0.2
"""Of a frame: less makes no difference to what is marked or tracked."""


@dataclass(frozen=True)
class FilmLength:
    """How long a camera filmed: its name, its frames, and how many of them a second."""

    camera: str
    frames: int
    fps: float

    @property
    def seconds(self) -> float:
        return self.frames / self.fps


def find_length_faults(lengths: Sequence[FilmLength], find_offsets: bool) -> list[str]:
    """Which videos are too short to be of the same, and without offsets which differ in length; a sentence for each."""
    faults = []
    longest = max(lengths, key=lambda length: length.seconds, default=None)
    for own in lengths:
        assert longest is not None
        if own.seconds < STOPS * longest.seconds:
            faults.append(
                f"{own.camera}: stops in the middle: its video has {own.frames} frames ({own.seconds:.1f} s), that of "
                f"{longest.camera} lasts {longest.seconds:.1f} s. Film again, leave this camera out, or cut the others "
                "to the part that all have."
            )
        elif not find_offsets and abs(own.seconds - longest.seconds) * own.fps > 0.5:
            faults.append(
                f"{own.camera}: its video has {own.frames} frames ({own.seconds:.2f} s), that of {longest.camera} "
                f"lasts {longest.seconds:.2f} s, so frames of one number need not show one moment. Let the offsets be "
                "found, or cut the videos to one length."
            )
    return faults


def check_lengths(sightings: Sequence[Sightings], find_offsets: bool) -> None:
    """Videos long enough to be of the same, and without offsets of equal length.

    Raises:
        CalibrationError: Names the camera.
    """
    faults = find_length_faults(
        [FilmLength(seen.camera, len(seen.times), seen.fps) for seen in sightings], find_offsets
    )
    if faults:
        raise CalibrationError(faults[0])


def find_warnings(result: CameraCalibration, sightings: Sequence[Sightings], find_offsets: bool) -> list[str]:
    """What a person should look at before using the result."""
    longest = max(len(seen.times) / seen.fps for seen in sightings)
    warnings = []
    for number, seen in enumerate(sightings):
        faults = (
            _judge_length(seen, longest),
            _judge_offset(result.offsets[number], sightings[0].camera, find_offsets) if number else "",
            _judge_left_out(result.left_out.choose(result.left_out.camera == number)),
            _judge_reach(seen),
        )
        warnings += [f"{seen.camera}: {fault}" for fault in faults if fault]
    hidden = int((~np.isfinite(result.T_world_board[:, 0, 0])).sum())
    if hidden:
        warnings.append(
            f"{say_count(hidden, 'board')} could not be placed and {'is' if hidden == 1 else 'are'} left out."
        )
    return warnings


def _judge_length(seen: Sightings, longest: float) -> str:
    seconds = len(seen.times) / seen.fps
    if (longest - seconds) * seen.fps <= FRAMES_APART:
        return ""
    return (
        f"its video is shorter ({len(seen.times)} frames, {seconds:.2f} s) than the longest ({longest:.2f} s); only "
        "what all have can be used of a recording made like this."
    )


def _judge_offset(offset: TimeOffset, first: str, find_offsets: bool) -> str:
    if not offset.is_known:
        text = (
            "the board moved too little, or was too seldom seen with the others, to tell a time offset; none is "
            "assumed. Move the board without pause to have it told."
        )
        return text if find_offsets else ""
    if abs(offset.frames) <= OUT_OF_STEP:
        return ""
    later = "later" if offset.frames > 0 else "earlier"
    return (
        f"is out of step: it shows a moment {abs(offset.frames):.2f} frames ({abs(1000 * offset.seconds):.1f} ms) "
        f"{later} in its video than {first}. Shift it by that."
    )


def _judge_left_out(own: BoardResiduals) -> str:
    if len(own.px) == 0:
        return "no board at the moments that were left out; nothing judges this camera."
    if own.median <= BAD_PX:
        return ""
    return (
        f"{own.median:.1f} px (median) at moments that were left out; needed at most {BAD_PX:g}. Is the board flat, "
        "its size right, the picture sharp, and did the camera stay where it was?"
    )


def _judge_reach(seen: Sightings) -> str:
    size = np.array([seen.width, seen.height])
    reach = np.ptp(seen.corners.reshape(-1, 2)[np.isfinite(seen.corners[..., 0]).ravel()], axis=0)
    if (reach >= 0.5 * size).all():
        return ""
    across, down = (round(100 * share) for share in reach / size)
    return (
        f"the board covered only {across} % of the picture's width and {down} % of its height; outside, the lens is a "
        "guess."
    )
