"""How well cameras are calibrated: `python -m benchmarks.camera_calibration [FOLDER]`.

Boards waved in front of known cameras, corners with Gaussian noise of 0.2 px, lenses unknown, videos out of step by
fractions of a frame: how far centres, directions, focal lengths and time offsets are from the truth. FOLDER holds
`caliscope_sessions`, boards filmed by 2 and 4 cameras: residuals of what the cameras were fitted to and of what was
left out, with and without time offsets.
"""

from __future__ import annotations

import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

from tests.tracker.calibration.filmed_board import film, measure_places
from tracker.calibration.board_file import load_board
from tracker.calibration.calibrate import CalibrationOptions, calibrate_cameras
from tracker.calibration.camera_source import find_sources
from tracker.calibration.lens import Lens
from tracker.calibration.sightings import find_sightings

OFFSETS_S = (0.0, 1.3777, -0.3123, 0.0051, 0.4, -0.55, 0.6017, 0.0333)
SESSIONS = ("post_optimization", "charuco_calibration_2_cam")


def measure_truth(count: int, seconds: float, knows_lenses: bool) -> str:
    """A row: known cameras, two seeds, the worse of both."""
    filmed = film(count, OFFSETS_S[:count], seconds=seconds)
    options = CalibrationOptions(max_offset_s=2.0)
    if knows_lenses:
        options = replace(options, lenses={camera.id: Lens(camera.K, camera.distortion) for camera in filmed.cameras})
    rows = []
    for seed in (0, 1):
        sightings = filmed.sight_all(seed)
        began = time.perf_counter()
        result = calibrate_cameras(sightings, filmed.board, options)
        taken = time.perf_counter() - began
        metres, degrees = measure_places(result.cameras, filmed.cameras)
        late = [found.seconds - true for found, true in zip(result.offsets, filmed.offsets, strict=True)]
        focal = [abs(a.K[0, 0] / b.K[0, 0] - 1) for a, b in zip(result.cameras, filmed.cameras, strict=True)]
        rows.append(
            (
                1000 * metres.max(),
                degrees.max(),
                1000 * np.abs(late).max(),
                100 * max(focal),
                result.left_out.rms,
                taken,
            )
        )
    mm, angle, ms, percent, px, taken = np.max(rows, axis=0)
    what = f"{count} | {seconds:g} | {'known' if knows_lenses else 'unknown'}"
    return f"| {what} | {mm:.2f} | {angle:.3f} | {ms:.2f} | {percent:.2f} | {px:.2f} | {taken:.1f} |"


def measure_session(folder: Path, name: str) -> list[str]:
    """Rows of a recorded session, without and with time offsets."""
    board = load_board(folder / name / "charuco.toml")
    began = time.perf_counter()
    sources = find_sources([folder / name / "calibration" / "extrinsic"])
    sightings = [find_sightings(source, board) for source in sources]
    looking = time.perf_counter() - began
    rows = []
    for find_offsets in (False, True):
        began = time.perf_counter()
        result = calibrate_cameras(sightings, board, CalibrationOptions(find_offsets=find_offsets))
        taken = time.perf_counter() - began
        values = [f"{part.rms:.2f} / {part.median:.2f}" for part in (result.residuals, result.fitted, result.left_out)]
        values.append(f"{result.other_cameras_residuals.rms:.2f} / {result.other_cameras_residuals.median:.2f}")
        told = ", ".join(f"{1000 * offset.seconds:+.0f}" for offset in result.offsets[1:])
        late = told if find_offsets else "not looked for"
        rows.append(f"| `{name}` | {late} | {' | '.join(values)} | {looking:.1f} + {taken:.1f} |")
    return rows


def main() -> None:
    print("| cameras | s filmed | lenses | centre mm | direction deg | offset ms | focal % | left out px rms | s |")
    print("|---|---|---|---|---|---|---|---|---|")
    for count, seconds, knows_lenses in ((2, 30, False), (4, 30, False), (4, 30, True), (8, 30, False)):
        print(measure_truth(count, seconds, knows_lenses), flush=True)
    if len(sys.argv) > 1:
        print("\n| session | offsets ms | all px | fitted px | left out px | by the others px | s looking + solving |")
        print("|---|---|---|---|---|---|---|")
        for name in SESSIONS:
            print("\n".join(measure_session(Path(sys.argv[1]) / "caliscope_sessions", name)), flush=True)


if __name__ == "__main__":
    main()
