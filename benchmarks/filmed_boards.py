"""From a filmed board to tracked hands: `python -m benchmarks.filmed_boards DATA [--out DIR] [--write]`.

DATA holds `caliscope_sessions`: films of a person who holds a calibration board in both hands, with a face, bare
forearms and a cluttered room in view, six frames a second. Cameras are calibrated from the board, then both hands are
tracked in the same films, by the commands that a user would run. One rule was made after looking at these films: with
one camera, a new hand must be one in a larger square too (a red tool was taken for a hand). Nothing else was chosen.
With `--write` the table goes into `benchmarks/results/filmed_boards.md`.
"""

from __future__ import annotations

import argparse
import json
import shutil
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

from benchmarks.result_page import write_result

ROOT = Path(__file__).resolve().parents[1]
SESSIONS = {"two cameras": "charuco_calibration_2_cam", "four cameras": "post_optimization"}
HEAD = (
    "| film | tracked in | frames | right, left hand held | fitted joints to detected ones, px "
    "| the same in a view left out, px | ms median | calibrated in s |\n|---|---|---|---|---|---|---|---|"
)


def handloom(*arguments: str) -> float:
    """Run a command of the program, and say how long it took, in s."""
    before = time.perf_counter()
    subprocess.run([str(Path(sys.executable).parent / "handloom"), *arguments], check=True, stderr=subprocess.DEVNULL)
    return time.perf_counter() - before


def calibrate(session: Path, out: Path) -> float:
    """A folder of films with the cameras found from them; seconds of the calibration."""
    films = session / "calibration" / "extrinsic"
    out.mkdir(parents=True, exist_ok=True)
    for film in sorted(films.glob("*.mp4")):
        shutil.copy(film, out)
    board = str(session / "charuco.toml")
    return handloom("calibrate-cameras", str(films), "--board", board, "--out", str(out / "calibration.toml"))


def describe(name: str, track: Path, seconds: float | None) -> str:
    """A row of the table."""
    summary = json.loads((track / "summary.json").read_text())
    with np.load(track / "track.npz") as arrays:
        status = arrays["hand_status"]
    held = [f"{np.count_nonzero(hand != 'lost')}" for hand in status.T]
    views = summary["views"].values()
    fitted = ", ".join(f"{view['fit_px']:.1f}" for view in views)
    left_out = [f"{view['left_out_px']:.1f}" for view in views if view["left_out_px"] is not None]
    return (
        f"| {name} | {', '.join(summary['colour_cameras'])} | {len(status)} | {', '.join(held)} | {fitted} | "
        f"{', '.join(left_out)} | {summary['median_ms']:.0f} | {'' if seconds is None else f'{seconds:.1f}'} |"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data", type=Path)
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "filmed_boards", help="for films and tracks")
    parser.add_argument("--write", action="store_true", help="write the page into benchmarks/results")
    given = parser.parse_args()
    rows = []
    for name, folder in SESSIONS.items():
        films = given.out / folder
        seconds = calibrate(given.data / "caliscope_sessions" / folder, films)
        names = sorted(film.stem for film in films.glob("*.mp4"))
        for cameras in (names, *([camera] for camera in names[: 2 if len(names) == 2 else 0])):
            track = given.out / f"{folder}_{'_'.join(cameras)}"
            handloom("track", str(films), "--hands", "right,left", "--cameras", ",".join(cameras), "--out", str(track))
            rows.append(describe(name, track, seconds if cameras == names else None))
            print(rows[-1], flush=True)
    text = f"{' '.join((__doc__ or '').split(chr(10) * 2)[1].split())}\n\n{HEAD}\n" + "\n".join(rows)
    if given.write:
        write_result(
            "filmed_boards", "From a filmed board to tracked hands", "python -m benchmarks.filmed_boards DATA", text
        )


if __name__ == "__main__":
    main()
