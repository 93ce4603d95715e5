"""One run: `python -m benchmarks.constants.trial DATA WORK [MODULE NAME VALUE]` prints what was measured.

The last line is JSON."""

from __future__ import annotations

import ast
import hashlib
import json
import os
import sys
import time
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ.setdefault(name, "1")  # before numpy: one thread is measured

from benchmarks.constants.numbers import ChangedNumber, list_numbers  # noqa: E402
from benchmarks.constants.reached import choose_reached, record_calls  # noqa: E402

if TYPE_CHECKING:
    from benchmarks.real_marks.marked import MarkedRecording
    from tracker.tracking.frame_result import FrameResult

RECORDINGS = ("uvr_cube_white", "uvr_sphere_green", "d405_take001_cam0")
"""The recordings with depth and colour that were marked by eye and show the hand whole in most frames."""


FRAMES = 100
"""Of each recording: with 15 of the marked frames and 88 of their fingertips, and a number costs 20 s."""


@dataclass(frozen=True)
class Measured:
    """What one recording came to, with the default hand.

    Attributes:
        recording: Its name.
        right: Fingertips within the recording's limit.
        tips: Fingertips marked.
        lost: Frames called lost.
        wrong: Frames called `ok` with a fingertip in a wrong place.
        seconds: Of the processor.
        track: A digest of every pose; two runs with the same one followed the hand alike to the last bit.
    """

    recording: str
    right: int
    tips: int
    lost: int
    wrong: int
    seconds: float
    track: str


def measure(data: Path, work: Path) -> list[Measured]:
    """Track the first frames of the recordings and compare them with their marks."""
    from benchmarks.real_marks.marked import load_marked_recordings  # only now is the tracker imported

    return [follow(recording, data, work) for recording in load_marked_recordings(data, list(RECORDINGS))]


def follow(recording: MarkedRecording, data: Path, work: Path) -> Measured:
    from benchmarks.real_marks.agreement import compare
    from tracker.fitting.options import TrackOptions
    from tracker.tracking.follow import track_frames
    from tracker.tracking.start import start_tracking

    sequence, began = recording.read(data, work), time.process_time()
    options = TrackOptions(calibrate=False, last_frame=FRAMES - 1)
    setup, state = start_tracking(sequence, options)
    joints, lost, digest = {}, set(), hashlib.sha256()

    def keep(_: object, result: FrameResult) -> None:
        index = setup.names.index(recording.hand)
        pose = setup.scene.pose_at(result.pose)
        joints[result.frame] = sequence.cameras[0].project(pose.landmarks(index))
        digest.update(result.pose.tobytes() + result.status.encode())
        if result.status == "lost":
            lost.add(result.frame)

    track_frames(sequence, setup, state, options.frame_range(sequence.frame_count), keep)
    marks = {frame: points for frame, points in recording.marks.items() if frame < FRAMES}
    told = compare(marks, joints, lost, recording.limit)
    right, seconds = round(told.within * told.tips), round(time.process_time() - began, 2)
    return Measured(recording.name, right, told.tips, len(lost), len(told.misses), seconds, digest.hexdigest()[:16])


def main(arguments: list[str]) -> None:
    """Measure; with `reached` in place of a number, list those that a run reads."""
    data, work, *changed = arguments
    if changed == ["reached"]:
        with record_calls() as called:
            measure(Path(data), Path(work))
        print(json.dumps([[one.module, one.name] for one in choose_reached(list_numbers(), called)]))
        return
    if changed:
        module, name, text = changed
        ChangedNumber(module, name, ast.literal_eval(text)).install()
    print(json.dumps([asdict(one) for one in measure(Path(data), Path(work))]))


if __name__ == "__main__":
    main(sys.argv[1:])
