"""Real recordings, changed: `python -m benchmarks.real_marks.changed DATA [--only NAME ...] [--write]`.

The same hands as in `benchmarks.real_marks`, mirrored (a left hand), upside down, backwards (another start), with every
second and every third frame left (two and three times the motion), and with dim colours. Nothing was
chosen on these, but that dim images are brightened was seen to be needed on them.
With `--write` the table goes into `benchmarks/results/real_changed.md`.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ.setdefault(name, "1")  # before numpy: one thread is measured

import numpy as np  # noqa: E402
import numpy.typing as npt  # noqa: E402

from benchmarks.real_marks.__main__ import follow  # noqa: E402
from benchmarks.real_marks.agreement import compare  # noqa: E402
from benchmarks.real_marks.marked import MarkedRecording, load_marked_recordings  # noqa: E402
from benchmarks.result_page import write_result  # noqa: E402
from tracker.capture.sequence import Sequence  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
RECORDINGS = ("uvr_cube_white", "uvr_sphere_green", "d405_take001_cam0")
HEAD = (
    "| recording | change | hand | frames | lost | tips | right | median px | ok but wrong |\n"
    "|---|---|---|---|---|---|---|---|---|"
)
OTHER = {"right": "left", "left": "right"}


@dataclass(frozen=True)
class Change:
    """What is done to a recording.

    Attributes:
        name: For people.
        step: From one shown frame to the next; -1 backwards.
        flips: Columns and rows of the images that are turned round, -1, or not, 1.
        light: Share of the colours' brightness that is left.
    """

    name: str
    step: int = 1
    flips: tuple[int, int] = (1, 1)
    light: float = 1.0

    def of_image(self, image: npt.NDArray) -> npt.NDArray:
        columns, rows = self.flips
        return np.ascontiguousarray(image[::rows, ::columns])

    def of_points(self, points: npt.NDArray, width: int, height: int) -> npt.NDArray:
        """(N, 2) px."""
        mirrored = np.array([width - 1, height - 1]) - points
        return np.where(np.array(self.flips) < 0, mirrored, points)

    @property
    def is_mirrored(self) -> bool:
        return self.flips[0] * self.flips[1] < 0


CHANGES = (
    Change("mirrored", flips=(-1, 1)),
    Change("upside down", flips=(-1, -1)),
    Change("backwards", step=-1),
    Change("every 2nd frame", step=2),
    Change("every 3rd frame", step=3),
    Change("0.4 of the light", light=0.4),
    Change("0.2 of the light", light=0.2),
)


@dataclass(frozen=True, eq=False)
class ChangedSequence(Sequence):
    """A recording that shows another's images, changed."""

    original: Sequence | None = None
    change: Change = Change("as it is")

    @classmethod
    def of(cls, original: Sequence, change: Change) -> ChangedSequence:
        (camera,), order = original.cameras, range(original.frame_count)[:: change.step]
        K = np.array(camera.K)
        K[:2, 2] = change.of_points(K[:2, 2], camera.width, camera.height)
        facts = {name: getattr(original, name) for name in ("folder", "name", "hands")}
        if change.is_mirrored:
            facts["hands"] = tuple(OTHER[hand] for hand in original.hands)
        fps = original.fps / abs(change.step)
        cameras = (replace(camera, K=K),)
        return cls(**facts, fps=fps, frame_count=len(order), cameras=cameras, original=original, change=change)

    def color(self, index: int, camera_id: str) -> npt.NDArray[np.uint8]:
        image = self._read(Sequence.color, index, camera_id)
        return image if self.change.light == 1.0 else (self.change.light * image).astype(np.uint8)

    def depth_raw(self, index: int, camera_id: str) -> npt.NDArray[np.uint16]:
        return self._read(Sequence.depth_raw, index, camera_id)

    def _read(self, read: Callable[[Sequence, int, str], npt.NDArray], index: int, camera_id: str) -> npt.NDArray:
        assert self.original is not None
        frame = range(self.original.frame_count)[:: self.change.step][index]
        return self.change.of_image(read(self.original, frame, camera_id))


def measure(recording: MarkedRecording, original: Sequence, change: Change) -> list[str]:
    """Rows of the table."""
    sequence, camera = ChangedSequence.of(original, change), original.cameras[0]
    order = list(range(original.frame_count)[:: change.step])
    marks = {
        order.index(frame): change.of_points(points, camera.width, camera.height)
        for frame, points in recording.marks.items()
        if frame in order
    }
    rows = []
    for way, calibrate in (("default", False), ("shape fitted", True)):
        track, joints, _ = follow(sequence, sequence.hands[0], calibrate)
        lost = set(track.frame[track.status == "lost"].tolist())
        head = f"| {recording.name} | {change.name} | {way} | {len(order)} | {len(lost)} |"
        if not marks:
            rows.append(f"{head} | | | |")
            continue
        found = compare(marks, joints, lost, recording.limit)
        wrong = f"{len(found.misses)} of {found.marked}"
        rows.append(f"{head} {found.tips} | {100 * found.within:.0f} % | {found.median:.1f} | {wrong} |")
        print(rows[-1], found.misses, flush=True)
    return rows


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data", type=Path)
    parser.add_argument("--only", nargs="+", metavar="NAME", default=list(RECORDINGS))
    parser.add_argument("--work", type=Path, default=ROOT / "out" / "real_marks")
    parser.add_argument("--write", action="store_true", help="write the table into benchmarks/results")
    given = parser.parse_args()
    recordings = load_marked_recordings(given.data, given.only)
    if not recordings:
        print(f"{given.data} holds none of {', '.join(given.only)}.")
        return 2
    rows = [HEAD]
    for recording in recordings:
        original = recording.read(given.data, given.work)
        for change in CHANGES:
            rows += measure(recording, original, change)
    about = " ".join((__doc__ or "").split("\n\n")[1].split())
    if given.write:
        command = "python -m benchmarks.real_marks.changed DATA --write"
        write_result("real_changed", "Real recordings, changed", command, f"{about}\n\n" + "\n".join(rows))
    return 0


if __name__ == "__main__":
    sys.exit(main())
