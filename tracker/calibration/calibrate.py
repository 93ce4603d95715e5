"""From sightings of a board to calibrated cameras: lenses, pairs, places, bundle adjustment, and a judgement."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from tracker.calibration.arrangement import Arrangement
from tracker.calibration.board import Board
from tracker.calibration.board_places import find_board_places
from tracker.calibration.board_pose import find_board_poses
from tracker.calibration.bundle import Freedom, adjust
from tracker.calibration.camera_calibration import CameraCalibration, TimeOffset
from tracker.calibration.camera_faults import check_lengths, find_warnings
from tracker.calibration.camera_graph import place_cameras, relate_all
from tracker.calibration.camera_pair import MIN_SHARED, SeenBoards
from tracker.calibration.camera_source import MAX_CAMERAS
from tracker.calibration.judgement import judge
from tracker.calibration.lens import Lens, fit_lens
from tracker.calibration.moments import choose_moments, count_cameras, leave_out, list_moments, read_corners
from tracker.calibration.projection import DISTORTION_PARAMETERS
from tracker.calibration.sightings import Report, Sightings
from tracker.capture.camera import Camera
from tracker.errors import CalibrationError
from tracker.geometry.se3 import inverse

Array = npt.NDArray[np.float64]
Mask = npt.NDArray[np.bool_]

FIRST_MOMENTS = 150
"""Moments that the first two rounds of bundle adjustment fit and judge; the last round takes more, from nearly the
right place. After each round the corners are read again at the time offsets that were found."""


@dataclass(frozen=True)
class CalibrationOptions:
    """How to calibrate.

    Attributes:
        find_offsets: Look for time offsets; otherwise frames of one number show one moment.
        max_offset_s: How far videos may be out of step, s.
        lenses: Known lenses by the cameras' names; they stay as they are.
        left_out: Share of the time that is left out and judged by.
        most_moments: So many moments are adjusted at most.
        robust_px: Where residuals begin to count less.
    """

    find_offsets: bool = True
    max_offset_s: float = 10.0
    lenses: dict[str, Lens] | None = None
    left_out: float = 0.2
    most_moments: int = 600
    robust_px: float = 1.0


def calibrate_cameras(
    sightings: Sequence[Sightings],
    board: Board,
    options: CalibrationOptions | None = None,
    report: Report = lambda what, share: None,
) -> CameraCalibration:
    """Calibrate 2 to 16 cameras from where they saw a board.

    The world is the first camera's frame, in metres by the board's size.

    Args:
        sightings: Of each camera.
        board: The board.
        options: How.
        report: Told of each step; what it raises ends the work.

    Raises:
        CalibrationError: The sightings do not tell the cameras; says which camera and what to do.
    """
    options = options or CalibrationOptions()
    if not 2 <= len(sightings) <= MAX_CAMERAS:
        raise CalibrationError(f"{len(sightings)} cameras; needed 2 to {MAX_CAMERAS}.")
    check_lengths(sightings, options.find_offsets)
    lenses = _find_lenses(sightings, board, options, report)
    seen = []
    for number, (own, lens) in enumerate(zip(sightings, lenses, strict=True)):
        seen.append(SeenBoards(own, lens, find_board_poses(board, lens, own.corners)))
        report("placing the boards", (number + 1) / len(sightings))
    pairs = relate_all(board, seen, options.max_offset_s if options.find_offsets else 0.0, report)
    places, offsets, is_told = place_cameras(board, seen, pairs)
    is_told = is_told & options.find_offsets
    is_told[0] = True
    sizes = np.array([(own.width, own.height) for own in sightings], dtype=np.float64)
    cameras = _arrange(lenses, places, sizes)
    moments = list_moments(sightings, offsets)
    everything = read_corners(board, sightings, moments, offsets, is_told)
    out = leave_out(moments, options.left_out)
    few = choose_moments(everything, sizes, ~out, min(FIRST_MOMENTS, options.most_moments))
    many = choose_moments(everything, sizes, ~out, options.most_moments)
    judged = np.flatnonzero(out & (count_cameras(everything, len(moments), len(sightings)) > 0))
    judged = judged[np.unique(np.linspace(0, len(judged) - 1, FIRST_MOMENTS).astype(int))] if len(judged) else judged
    freedom = Freedom(lenses=options.lenses is None, offsets=bool(is_told[1:].any()))
    fitted = cameras
    for turn, chosen in enumerate((few, few, many)):
        report("adjusting cameras and boards", turn / 3)
        fitted, offsets = _adjust_once(board, sightings, moments[chosen], fitted, offsets, is_told, freedom, options)
    report("judging the cameras on what was left out", 0.0)
    used = np.concatenate([few, judged])
    is_left_out = np.arange(len(used)) >= len(few)
    residuals, others, T_world_board = judge(board, sightings, moments[used], fitted, offsets, is_told, is_left_out)
    result = CameraCalibration(
        board=board,
        cameras=tuple(_make_camera(own, fitted, number) for number, own in enumerate(sightings)),
        offsets=tuple(
            TimeOffset(float(offset), float(offset * own.fps), bool(told))
            for offset, own, told in zip(offsets, sightings, is_told, strict=True)
        ),
        moments=moments[used],
        is_left_out=is_left_out,
        T_world_board=T_world_board,
        residuals=residuals,
        other_cameras_residuals=others,
        frame_counts=tuple(len(own.times) for own in sightings),
        sighting_counts=tuple(len(own.frames) for own in sightings),
        warnings=(),
    )
    report("judging the cameras on what was left out", 1.0)
    return replace(result, warnings=tuple(find_warnings(result, sightings, options.find_offsets)))


def _find_lenses(
    sightings: Sequence[Sightings], board: Board, options: CalibrationOptions, report: Report
) -> list[Lens]:
    lenses = []
    for number, own in enumerate(sightings):
        if options.lenses is None:
            lenses.append(fit_lens(own, board))
        elif own.camera in options.lenses:
            lenses.append(options.lenses[own.camera])
        else:
            known = ", ".join(options.lenses)
            raise CalibrationError(f"{own.camera}: no lens of this name was given (there are {known}).")
        if lenses[-1].distortion.size > DISTORTION_PARAMETERS:
            raise CalibrationError(
                f"{own.camera}: its lens has a tilted sensor (14 coefficients); at most 12 are used."
            )
        report("finding the lenses", (number + 1) / len(sightings))
    return lenses


def _arrange(lenses: Sequence[Lens], places: Array, sizes: Array) -> Arrangement:
    distortion = np.zeros((len(lenses), DISTORTION_PARAMETERS))
    for row, lens in zip(distortion, lenses, strict=True):
        row[: lens.distortion.size] = lens.distortion
    T_camera_world = np.array([inverse(T) for T in places])
    K = np.array([lens.K for lens in lenses])
    return Arrangement(K, distortion, T_camera_world, np.zeros((0, 4, 4)), np.zeros(len(lenses)), sizes)


def _adjust_once(
    board: Board,
    sightings: Sequence[Sightings],
    moments: Array,
    cameras: Arrangement,
    offsets: Array,
    is_told: Mask,
    freedom: Freedom,
    options: CalibrationOptions,
) -> tuple[Arrangement, Array]:
    """Read the corners at the offsets, place the boards, adjust; the cameras and their offsets then."""
    corners = read_corners(board, sightings, moments, offsets, is_told)
    boards = find_board_places(board, cameras, corners, len(moments))
    is_placed = np.isfinite(boards[:, 0, 0])
    corners = corners.choose(is_placed[corners.moment])
    if count_cameras(corners, len(moments), len(sightings)).max(initial=0) < 2:
        raise CalibrationError(
            f"No two cameras see the board at one moment outside what is left out; needed {MIN_SHARED} such moments."
        )
    start = replace(
        cameras, T_world_board=np.where(is_placed[:, None, None], boards, np.eye(4)), offsets=np.zeros(len(sightings))
    )
    fitted = adjust(start, corners, freedom, options.robust_px)
    return fitted, offsets + fitted.offsets


def _make_camera(own: Sightings, fitted: Arrangement, number: int) -> Camera:
    distortion = fitted.distortion[number]
    used = 12 if distortion[8:].any() else 8 if distortion[5:].any() else 5 if distortion.any() else 0
    return Camera(
        id=own.camera,
        width=own.width,
        height=own.height,
        K=fitted.K[number],
        distortion=distortion[:used].copy(),
        T_world_camera=inverse(fitted.T_camera_world[number]),
    )
