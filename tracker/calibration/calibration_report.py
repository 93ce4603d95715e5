"""What a calibration found, for programs (JSON) and for people (text)."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tracker.calibration.camera_calibration import BoardResiduals, CameraCalibration


def describe_calibration(result: CameraCalibration) -> dict[str, Any]:
    """All of it as plain values: cameras, offsets, residuals by camera and by board, warnings. In m, s and px."""
    fitted, left_out, others = result.fitted, result.left_out, result.other_cameras_residuals
    cameras = []
    for number, (camera, offset) in enumerate(zip(result.cameras, result.offsets, strict=True)):
        own = {
            name: _measure(residuals.choose(residuals.camera == number))
            for name, residuals in (("fitted", fitted), ("left_out", left_out), ("by_other_cameras", others))
        }
        cameras.append(
            {
                "id": camera.id,
                "width": camera.width,
                "height": camera.height,
                "K": camera.K.tolist(),
                "distortion": camera.distortion.tolist(),
                "T_world_camera": camera.T_world_camera.tolist(),
                "frames": result.frame_counts[number],
                "frames_with_board": result.sighting_counts[number],
                "time_offset": {"seconds": offset.seconds, "frames": offset.frames, "known": offset.is_known},
                "residual_px": own,
            }
        )
    boards = []
    for number, (moment, T) in enumerate(zip(result.moments, result.T_world_board, strict=True)):
        seen = result.residuals.choose(result.residuals.moment == number)
        boards.append(
            {
                "seconds": float(moment),
                "left_out": bool(result.is_left_out[number]),
                "T_world_board": T.tolist() if np.isfinite(T).all() else None,
                "residual_px": {
                    result.cameras[camera].id: _measure(seen.choose(seen.camera == camera))
                    for camera in np.unique(seen.camera)
                },
            }
        )
    return {
        "version": 1,
        "world": f"the frame of {result.cameras[0].id}, in metres by the board's size",
        "board": result.board.describe(),
        "residual_px": {
            "fitted": _measure(fitted),
            "left_out": _measure(left_out),
            "by_other_cameras": _measure(others),
        },
        "cameras": cameras,
        "boards": boards,
        "warnings": list(result.warnings),
    }


def say_calibration(result: CameraCalibration) -> str:
    """A table of the cameras and what to look at."""
    lines = [
        f"{result.board.describe()}; {len(result.cameras)} cameras, judged at {len(result.moments)} moments, "
        f"{int(result.is_left_out.sum())} of them left out of the fit.",
        "",
        f"{'camera':<16}{'frames':>8}{'boards':>8}{'fitted px':>16}{'left out px':>16}{'by the others':>16}"
        f"{'offset ms':>11}{'frames':>8}   from the first, m",
    ]
    tables = result.fitted, result.left_out, result.other_cameras_residuals
    for number, (camera, offset) in enumerate(zip(result.cameras, result.offsets, strict=True)):
        own = [_say(table.choose(table.camera == number)) for table in tables]
        step = f"{1000 * offset.seconds:>11.1f}{offset.frames:>8.2f}" if offset.is_known else f"{'not told':>19}"
        place = " ".join(f"{value:+.4f}" for value in camera.T_world_camera[:3, 3])
        lines.append(
            f"{camera.id[:15]:<16}{result.frame_counts[number]:>8}{result.sighting_counts[number]:>8}"
            f"{own[0]:>16}{own[1]:>16}{own[2]:>16}{step}   {place}"
        )
    lines += [
        f"{'all':<32}" + "".join(f"{_say(table):>16}" for table in tables),
        "",
        "Residuals are rms / median, px. Left out: moments the cameras were not fitted to. By the others: the same "
        "moments, "
        "the board placed by the other cameras alone.",
        "Offset: to be added to a time in the first camera's video to get that of the same moment in this one's.",
    ]
    if result.warnings:
        lines += ["", "To look at:", *(f"- {warning}" for warning in result.warnings)]
    return "\n".join(lines)


def _measure(residuals: BoardResiduals) -> dict[str, Any]:
    rms, median = (None if math.isnan(value) else round(value, 4) for value in (residuals.rms, residuals.median))
    return {"rms": rms, "median": median, "corners": len(residuals.px)}


def _say(residuals: BoardResiduals) -> str:
    return f"{residuals.rms:.2f} / {residuals.median:.2f}" if len(residuals.px) else "-"
