"""In how many images of real recordings the hand is found and its side told: `python -m benchmarks.found_hands DATA`.

The recordings of `benchmarks/real_marks/recordings`, each of which shows one right hand, followed from image to image.
Images in which none was found are named, to be looked at: some show no hand.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from itertools import groupby
from pathlib import Path

import numpy as np

from benchmarks.real_marks.marked import MarkedRecording, load_marked_recordings
from tracker.landmarks import DetectedHand, default_hand_detector

ROOT = Path(__file__).resolve().parents[1]


def read_images(recording: MarkedRecording, data: Path, work: Path) -> Iterator[np.ndarray]:
    """All colour or infrared images."""
    if not recording.has_depth:
        yield from recording.images(data)
        return
    sequence = recording.read(data, work)
    for index in range(sequence.frame_count):
        color = sequence.frame(index, sequence.cameras[0].id).color
        assert color is not None
        yield color


def name_runs(frames: list[int]) -> str:
    """Frames as `3-7, 9`."""
    runs = [[frame for _, frame in run] for _, run in groupby(enumerate(frames), lambda pair: pair[1] - pair[0])]
    return ", ".join(str(run[0]) if len(run) == 1 else f"{run[0]}-{run[-1]}" for run in runs) or "none"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data", type=Path)
    parser.add_argument("--only", nargs="+", metavar="NAME")
    parser.add_argument("--work", type=Path, default=ROOT / "out" / "real_marks", help="where recordings are imported")
    given = parser.parse_args()
    given.work.mkdir(parents=True, exist_ok=True)
    print("| recording | found | its side right, of those | not found in |\n|---|---|---|---|")
    for recording in load_marked_recordings(given.data, given.only):
        before: list[DetectedHand] = []
        sides: list[bool] = []
        missed: list[int] = []
        for index, image in enumerate(read_images(recording, given.data, given.work)):
            before = default_hand_detector().find(image, 1, before)
            sides += [hand.side == recording.hand for hand in before]
            missed += [] if before else [index]
        share = 100.0 * np.mean(sides) if sides else 0.0
        count = len(sides) + len(missed)
        print(f"| {recording.name} | {len(sides)} of {count} | {share:.1f} % | {name_runs(missed)} |", flush=True)


if __name__ == "__main__":
    main()
