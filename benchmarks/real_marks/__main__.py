"""Track real recordings and compare with marks: `python -m benchmarks.real_marks DATA [--only NAME ...] [--write]`.

DATA holds the recordings that the folders in `recordings/` name. Pictures of the marked frames go into the work folder
(`out/real_marks`): they show people and are not committed. With `--write` the table goes into
`benchmarks/results/real_marks.md`.
"""

from __future__ import annotations

import argparse
import os
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ.setdefault(name, "1")  # before numpy: one thread is measured

import numpy as np  # noqa: E402

from benchmarks.real_ball import add_ball, measure_radius  # noqa: E402
from benchmarks.real_marks.agreement import Agreement, compare  # noqa: E402
from benchmarks.real_marks.marked import MarkedRecording, load_marked_recordings  # noqa: E402
from benchmarks.real_marks.pictures import draw_frames  # noqa: E402
from tracker.capture.sequence import Sequence, load_sequence  # noqa: E402
from tracker.fitting.options import TrackOptions  # noqa: E402
from tracker.landmarks import DetectedHand, default_hand_detector  # noqa: E402
from tracker.tracking.follow import track_frames  # noqa: E402
from tracker.tracking.frame_result import FrameResult  # noqa: E402
from tracker.tracking.start import start_tracking  # noqa: E402
from tracker.tracking.track import Track, join_chunks  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "benchmarks" / "results" / "real_marks.md"
WITH_BALL = "shape fitted, ball's model"
HEAD = (
    "| recording | way | frames | lost | lost, of those that show it whole | tips | right | median px | "
    "lost but right | ok but wrong | ms median | 95 % | most |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|"
)


def detect_alone(recording: MarkedRecording, images: Iterator[np.ndarray]) -> tuple[dict[int, np.ndarray], int]:
    """Joints (21, 2) px of every frame in which the detector sees a hand, without any tracking; and all frames."""
    detector, found, before, count = default_hand_detector(), {}, [], 0
    for count, image in enumerate(images, 1):
        hands: list[DetectedHand] = detector.find(image, 1, before)
        before = hands
        if hands:
            found[count - 1] = hands[0].with_finger_ends().points
    return found, count


def follow(sequence: Sequence, hand: str, calibrate: bool) -> tuple[Track, dict[int, np.ndarray], np.ndarray]:
    """The track, joints (21, 2) px of every frame, and seconds (T,)."""
    options = TrackOptions(calibrate=calibrate)
    setup, state = start_tracking(sequence, options)
    results: list[FrameResult] = []
    frames = options.frame_range(sequence.frame_count)
    _, chunk = track_frames(sequence, setup, state, frames, lambda _, result: results.append(result))
    camera, index = sequence.cameras[0], setup.names.index(hand)
    joints = {one.frame: camera.project(setup.scene.pose_at(one.pose).landmarks(index)) for one in results}
    return join_chunks(sequence, setup, [chunk]), joints, np.array([one.seconds for one in results])


def copy_with_ball(sequence: Sequence, hand_alone: Track) -> Sequence:
    """The recording once more, beside itself, with a ball of the size that a track of the hand alone tells."""
    folder = sequence.folder.with_name(f"{sequence.folder.name}_with_ball")
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(sequence.folder, folder)
    copy = load_sequence(folder)
    return add_ball(copy, measure_radius(copy, hand_alone))


def write_row(
    recording: MarkedRecording, way: str, frames: int, lost: set[int], found: Agreement, seconds: np.ndarray | None
) -> str:
    name, whole = f"{recording.name}, {recording.limit:g} px", recording.list_whole(frames)
    times = " | | " if seconds is None else " | ".join(f"{1e3 * s:.0f}" for s in summarize(seconds))
    return (
        f"| {name} | {way} | {frames} | {len(lost)} | {len(lost & whole)} of {len(whole)} | {found.tips} | "
        f"{100 * found.within:.0f} % | {found.median:.1f} | {len(found.false_alarms)} of {found.marked} | "
        f"{len(found.misses)} of {found.marked} | {times} |"
    )


def summarize(seconds: np.ndarray) -> tuple[float, float, float]:
    """Median, 95 % and longest of the frames after the first."""
    later = seconds[1:]
    return float(np.median(later)), float(np.percentile(later, 95)), float(later.max())


def measure(recording: MarkedRecording, data: Path, work: Path) -> list[str]:
    """Rows of the table."""
    limit = recording.limit
    if not recording.has_depth:
        joints, count = detect_alone(recording, iter(recording.images(data)))
        unseen = set(range(count)) - set(joints)
        alone = compare(recording.marks, joints, unseen, limit)
        return [write_row(recording, "detector alone", count, unseen, alone, None)]
    sequence = recording.read(data, work)
    images = (sequence.frame(k, sequence.cameras[0].id).color for k in range(sequence.frame_count))
    joints, count = detect_alone(recording, (image for image in images if image is not None))
    unseen = set(range(count)) - set(joints)
    alone = compare(recording.marks, joints, unseen, limit)
    rows = [write_row(recording, "detector alone", count, unseen, alone, None)]
    followed = None
    for way, calibrate in (("default hand", False), ("shape fitted", True), (WITH_BALL, True)):
        if way == WITH_BALL:
            if followed is None or recording.about.get("holds") != "ball":
                continue
            sequence = copy_with_ball(sequence, followed)
        followed, joints, seconds = follow(sequence, recording.hand, calibrate)
        lost = set(followed.frame[followed.status == "lost"].tolist())
        found = compare(recording.marks, joints, lost, limit)
        rows.append(write_row(recording, way, count, lost, found, seconds))
        draw_frames(
            sequence, recording, joints, lost, work / f"{recording.name}_{way.split(',')[-1].replace(' ', '_')}.png"
        )
        print(rows[-1], "false alarms", found.false_alarms, "misses", found.misses, flush=True)
    return rows


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data", type=Path)
    parser.add_argument("--only", nargs="+", metavar="NAME")
    parser.add_argument("--work", type=Path, default=ROOT / "out" / "real_marks")
    parser.add_argument("--write", action="store_true", help="write the table into benchmarks/results")
    given = parser.parse_args()
    recordings = load_marked_recordings(given.data, given.only)
    if not recordings:
        print(f"{given.data} holds none of the recordings that {Path(__file__).parent}/recordings names.")
        return 2
    given.work.mkdir(parents=True, exist_ok=True)
    rows, passes = [], []
    for recording in recordings:
        rows += measure(recording, given.data, given.work)
        apart = recording.measure_passes()
        spread = f"{np.mean(apart):.2f} ± {np.std(apart):.2f}, median {np.median(apart):.2f}"
        passes.append(f"| {recording.name} | {len(recording.marks)} | {apart.size} | {spread} |")
    page = "\n".join(
        (
            "# Real recordings, by marks\n",
            "`make real DATA=FOLDER` writes this page. Each recording was marked twice by eye; a fingertip counts that",
            "both passes have within the limit that stands beside the recording's name. *Right*: within that limit.",
            "Whole: no part of the hand is cut off by the image, by eye (`whole` in `recording.json`).",
            "*Ok but wrong*: a frame that was not called lost with a fingertip more than twice the limit off.\n",
            HEAD,
            *rows,
            "\nBetween the two passes, px:\n",
            "| recording | frames | joints | mean and deviation |\n|---|---|---|---|",
            *passes,
            "",
        )
    )
    print(page)
    if given.write:
        PAGE.write_text(page)
    return 0


if __name__ == "__main__":
    sys.exit(main())
