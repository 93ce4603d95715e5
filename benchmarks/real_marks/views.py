"""Real hands before several colour or infrared cameras: `python -m benchmarks.real_marks.views DATA [--write]`.

Tracks `two_camera_rgb` in both views and `d405_take001` in all three left infrared views, without any annotation, and
the latter in two views at a time, judged by the marks in the third. DATA holds those recordings. With `--write` the
table goes into `benchmarks/results/real_views.md`.
"""

from __future__ import annotations

import argparse
import json
import os
from datetime import date
from itertools import product
from pathlib import Path

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ.setdefault(name, "1")  # before numpy: one thread is measured

import numpy as np  # noqa: E402
import numpy.typing as npt  # noqa: E402

from benchmarks.real_marks.marked import TIPS, MarkedRecording  # noqa: E402
from benchmarks.real_marks.outlines import measure_overlaps  # noqa: E402
from benchmarks.real_marks.stereo_depth import DEPTH_SCALE, write_images  # noqa: E402
from tracker.capture.frame_pattern import parse_pattern  # noqa: E402
from tracker.capture.import_options import ImportOptions  # noqa: E402
from tracker.capture.import_run import run_import  # noqa: E402
from tracker.capture.recorded_camera import RecordedCamera  # noqa: E402
from tracker.capture.sequence import Sequence, load_sequence, save_sequence_json  # noqa: E402
from tracker.capture.triangulation import triangulate  # noqa: E402
from tracker.fitting.options import TrackOptions  # noqa: E402
from tracker.landmarks import default_hand_detector  # noqa: E402
from tracker.tracking.follow import track_frames  # noqa: E402
from tracker.tracking.start import start_tracking  # noqa: E402
from tracker.tracking.track import Track, join_chunks  # noqa: E402

Array = npt.NDArray[np.float64]
ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "benchmarks" / "results" / "real_views.md"
SQUARE = 0.04
"""m, the side of the checkerboard's squares of `two_camera_rgb`."""

HEAD = (
    "| recording | tracked in | followed | judged in | joints | median px | within the limit | overlap | ms median "
    "| 95 % |\n|---|---|---|---|---|---|---|---|---|---|"
)


def read_two_cameras(data: Path, work: Path) -> Sequence:
    """`two_camera_rgb` as a recording."""
    out = work / "two_camera_rgb"
    if not (out / "sequence.json").exists():
        options = ImportOptions(hands=("right",), world_unit_m=SQUARE)
        run_import(data / "two_camera_rgb", out, "synced_videos", options)
    return load_sequence(out)


def read_infrared(data: Path, work: Path) -> Sequence:
    """The left infrared images of the cameras of `d405_take001`, with depth by stereo matching, as a recording."""
    out, source = work / "d405_take001_depth_views", data / "d405_take001"
    if (out / "sequence.json").exists():
        return load_sequence(out)
    cameras, count = [], 0
    for number, about in enumerate(json.loads((source / "meta.json").read_text())["cameras"]):
        lens, offset = about["ir_left"], about["ir_left_to_color"]
        K = np.array([[lens["fx"], 0.0, lens["ppx"]], [0.0, lens["fy"], lens["ppy"]], [0.0, 0.0, 1.0]])
        T_camera_world, T_camera_left = np.eye(4), np.eye(4)
        T_camera_world[:3, :3], T_camera_world[:3, 3] = about["R_world2cam"], about["t_world2cam"]
        T_camera_left[:3, :3] = np.reshape(offset["R"], (3, 3)).T
        T_camera_left[:3, 3] = offset["T"]
        count = write_images(source, number, out / f"cam{number}", out / f"cam{number}_depth")
        T = np.linalg.inv(T_camera_world) @ T_camera_left
        color, depth = (parse_pattern(f"cam{number}{kind}/{{:06d}}.png") for kind in ("", "_depth"))
        cameras.append(RecordedCamera(f"cam{number}", 640, 480, K, np.zeros(0), T, color, depth, DEPTH_SCALE))
    sequence = Sequence(out, "d405_take001", 4.5, count, tuple(cameras), ("right",))
    save_sequence_json(sequence)
    return sequence


def follow(sequence: Sequence, cameras: tuple[str, ...], use_depth: bool = False) -> Track:
    """The track in some cameras, without any annotation."""
    options = TrackOptions(cameras=",".join(cameras), use_depth=use_depth)
    setup, state = start_tracking(sequence, options)
    _, chunk = track_frames(sequence, setup, state, options.frame_range(sequence.frame_count))
    return join_chunks(sequence, setup, [chunk])


def judge(recording: MarkedRecording, track: Track, camera: str) -> tuple[Array, Array]:
    """Distances, px, of all marked joints from the track in one camera, and of fingertips; lost frames count too."""
    view = track.camera_ids.index(camera)
    apart = []
    for frame, marks in recording.marks.items():
        row = int(np.flatnonzero(track.frame == frame)[0])
        off = np.linalg.norm(track.joints_2d[row, :21, :][view] - marks, axis=1)
        apart.append(np.where(np.isfinite(marks).all(axis=1) & ~np.isfinite(off), np.inf, off))
    table = np.array(apart)
    return table[~np.isnan(table)], table[:, TIPS][~np.isnan(table[:, TIPS])]


def write_row(recording: MarkedRecording, sequence: Sequence, track: Track, camera: str) -> str:
    apart, tips = judge(recording, track, camera)
    overlaps = measure_overlaps(sequence, track, camera)
    overlap = f"{np.median(overlaps):.2f} ({overlaps.min():.2f})" if overlaps.size else ""
    held = int(np.count_nonzero(track.status != "lost"))
    milliseconds = 1000.0 * track.seconds[1:]
    return (
        f"| {recording.name.rpartition('_')[0]} | {', '.join(track.setup.view_ids)}"
        f"{' with depth' if track.setup.options.use_depth else ''} | {held} of {len(track.frame)} | "
        f"{camera} | {apart.size}, {tips.size} tips | {np.median(apart):.1f}, tips {np.median(tips):.1f} | "
        f"{100 * np.mean(apart < recording.limit):.0f} % < {recording.limit:g} px | {overlap} | "
        f"{np.median(milliseconds):.0f} | "
        f"{np.percentile(milliseconds, 95):.0f} |"
    )


def compare_points(sequence: Sequence, track: Track) -> float:
    """Median distance, mm, of the track's joints from those that the detector alone gives, triangulated."""
    detector, before = default_hand_detector(), [[] for _ in track.setup.view_ids]
    cameras = [sequence.camera(camera) for camera in track.setup.view_ids]
    apart = []
    for row, frame in enumerate(track.frame):
        seen = []
        for view, camera in enumerate(cameras):
            before[view] = detector.find(sequence.color(int(frame), camera.id), 1, before[view])
            seen.append(before[view][0].with_finger_ends().points if before[view] else np.full((21, 2), np.nan))
        points = triangulate(cameras, np.stack(seen, axis=1)).points
        if track.status[row] != "lost":
            apart.append(np.linalg.norm(points - track.joints_3d[row, :21], axis=1))
    return 1000.0 * float(np.nanmedian(apart))


def compare_marks(sequence: Sequence, track: Track, recordings: tuple[MarkedRecording, ...]) -> Array:
    """Distances (N,), mm, of the track's joints from those that are marked in all views, triangulated."""
    cameras = [sequence.camera(camera) for camera in track.setup.view_ids]
    apart = []
    for frame in sorted(set.intersection(*(set(one.marks) for one in recordings))):
        points = triangulate(cameras, np.stack([one.marks[frame] for one in recordings], axis=1)).points
        row = int(np.flatnonzero(track.frame == frame)[0])
        apart.append(1000.0 * np.linalg.norm(points - track.joints_3d[row, :21], axis=1))
    table = np.concatenate(apart)
    return table[np.isfinite(table)]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data", type=Path)
    parser.add_argument("--work", type=Path, default=ROOT / "out" / "real_views")
    parser.add_argument("--write", action="store_true", help="write the table into benchmarks/results")
    given = parser.parse_args()
    given.work.mkdir(parents=True, exist_ok=True)
    rows = []
    two = read_two_cameras(given.data, given.work)
    track = follow(two, ("cam0", "cam1"))
    folder = Path(__file__).parent / "recordings"
    marked = tuple(MarkedRecording.load(folder / f"two_camera_rgb_{camera}") for camera in ("cam0", "cam1"))
    rows += [write_row(one, two, track, camera) for one, camera in zip(marked, ("cam0", "cam1"), strict=True)]
    millimetres, from_marks = compare_points(two, track), compare_marks(two, track, marked)
    print(*rows, f"{millimetres:.1f} mm, {np.median(from_marks):.1f} mm", sep="\n", flush=True)
    infrared = read_infrared(given.data, given.work)
    ids = tuple(camera.id for camera in infrared.cameras)
    for use_depth, left_out in product((False, True), (None, *ids)):
        track = follow(infrared, tuple(camera for camera in ids if camera != left_out), use_depth)
        for camera in ids if left_out is None else (left_out,):
            rows.append(write_row(MarkedRecording.load(folder / f"d405_take001_{camera}"), infrared, track, camera))
            print(rows[-1], flush=True)
    page = "\n".join(
        (
            "# Real recordings of several cameras, by marks\n",
            "`python -m benchmarks.real_marks.views DATA --write` writes this page. No annotation is used; the hand's",
            "shape is fitted to the first seconds. Joints were marked twice by eye; frames that are called lost count.",
            "With depth: that of each infrared pair by stereo matching takes part too.",
            "*Judged in* a camera that is not among those tracked in: a left-out view. *Overlap*: intersection over",
            "union of the drawn hand and that outlined by eye, up to the wrist, median (least) of three frames.",
            f"Measured on {date.today()}; times of a busy machine.\n",
            HEAD,
            *rows,
            "\nIn `two_camera_rgb` the median distance of the track's joints from those of the detector alone,",
            f"triangulated, is {millimetres:.1f} mm; from the {from_marks.size} joints that are marked in both views,",
            f"triangulated, {np.median(from_marks):.1f} mm.",
        )
    )
    if given.write:
        PAGE.write_text(page + "\n")


if __name__ == "__main__":
    main()
