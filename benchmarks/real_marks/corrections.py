"""How many joints an annotator moves after accepting suggestions: `python -m benchmarks.real_marks.corrections DATA`.

In the marked frames of `d405_take001` the suggestions of all three infrared views are accepted at once, those of the
track or those of the hand detector. A joint needs a correction in a view where it lies farther
from its mark than the marks are good for (`right_within_px`), or is missing. `--write` writes
`benchmarks/results/corrections.md`.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable
from pathlib import Path

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ.setdefault(name, "1")  # before numpy: one thread is measured

import numpy as np  # noqa: E402
import numpy.typing as npt  # noqa: E402

from benchmarks.real_marks.marked import FOLDER, MarkedRecording  # noqa: E402
from benchmarks.real_marks.views import ROOT, follow, read_infrared  # noqa: E402
from benchmarks.result_page import write_result  # noqa: E402
from tracker.capture.sequence import Sequence  # noqa: E402
from tracker.landmarks import DetectedHand, default_hand_detector  # noqa: E402
from tracker.tracking.track import Track  # noqa: E402

Array = npt.NDArray[np.float64]
Suggest = Callable[[int, str], Array]
"""(21, 2) px of a frame in a camera; NaN where nothing is suggested."""

JOINTS, BAR = 21, 6


def suggest_from_track(track: Track) -> Suggest:
    """As the studio does; nothing where the track was lost."""

    def suggest(frame: int, camera: str) -> Array:
        row = int(np.flatnonzero(track.frame == frame)[0])
        joints = track.joints_2d[row, track.camera_ids.index(camera), :JOINTS]
        return joints if track.status[row] != "lost" else np.full_like(joints, np.nan)

    return suggest


def suggest_detected(sequence: Sequence) -> Suggest:
    """As after a job that looked through the whole recording."""
    detector, found = default_hand_detector(), {}
    for camera in sequence.cameras:
        before: list[DetectedHand] = []
        for frame in range(sequence.frame_count):
            before = detector.find(sequence.color(frame, camera.id), 1, before)
            if before:
                found[frame, camera.id] = before[0].with_finger_ends().points
    return lambda frame, camera: found.get((frame, camera), np.full((JOINTS, 2), np.nan))


def count_corrections(views: dict[str, MarkedRecording], suggest: Suggest, only: int | None) -> tuple[Array, Array]:
    """(T,) marked joints of each frame in all views together, and (T,) those that need a correction.

    Args:
        views: The marks of each camera.
        suggest: What is accepted.
        only: One pass's marks as they are; None: joints that both passes have alike.
    """
    frames = sorted(next(iter(views.values())).marks)
    marked, wrong = np.zeros(len(frames)), np.zeros(len(frames))
    for row, frame in enumerate(frames):
        for camera, recording in views.items():
            marks = recording.marks[frame] if only is None else recording.points(only, frame)
            off = np.linalg.norm(suggest(frame, camera) - marks, axis=1)
            is_marked = np.isfinite(marks).all(axis=1)
            marked[row] += np.count_nonzero(is_marked)
            wrong[row] += np.count_nonzero(is_marked & ~(off <= recording.limit))
    return marked, wrong


def write_row(way: str, whose: str, marked: Array, wrong: Array, views: int) -> str:
    share = wrong.sum() / marked.sum()
    return (
        f"| {way} | {whose} | {marked.mean():.1f} | {wrong.mean():.1f} | {', '.join(f'{n:.0f}' for n in wrong)} | "
        f"{np.count_nonzero(wrong <= BAR)} of {len(wrong)} | {100 * share:.0f} % | {share * views * JOINTS:.0f} |"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data", type=Path)
    parser.add_argument("--work", type=Path, default=ROOT / "out" / "real_views")
    parser.add_argument("--write", action="store_true", help="write benchmarks/results/corrections.md")
    given = parser.parse_args()
    given.work.mkdir(parents=True, exist_ok=True)
    sequence = read_infrared(given.data, given.work)
    ids = tuple(camera.id for camera in sequence.cameras)
    views = {camera: MarkedRecording.load(FOLDER / f"d405_take001_{camera}") for camera in ids}
    ways = {
        "track": suggest_from_track(follow(sequence, ids)),
        "hand detector": suggest_detected(sequence),
        "the other pass": lambda frame, camera: views[camera].points(1, frame),
    }
    rows = [
        "| accepted | marks | marked joints | corrections, mean | in each frame | at most 6 in | of the marked | "
        "as share of all 63 |\n|---|---|---|---|---|---|---|---|"
    ]
    for way, suggest in ways.items():
        for whose, only in (("both passes alike", None), ("first pass", 0), ("second pass", 1)):
            if way == "the other pass" and only != 0:
                continue
            rows.append(write_row(way, whose, *count_corrections(views, suggest, only), len(ids)))
            print(rows[-1], flush=True)
    if given.write:
        command = "python -m benchmarks.real_marks.corrections DATA --write"
        write_result("corrections", "Corrections after accepting suggestions", command, "\n".join(rows))


if __name__ == "__main__":
    main()
