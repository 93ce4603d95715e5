"""How exactly twins of T16's sequences are tracked: `python benchmarks/accuracy_twins.py FOLDER [--write]`.

FOLDER holds the authors' `Cameras.txt`, `models/` and `seq/`. The rendered model is the tracked one, the start is the
annotation of the first frame, the sensor noise is that of `handloom synthesize`.
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

import numpy as np

from tracker.capture.annotations import load_annotations
from tracker.capture.truth import load_truth
from tracker.evaluation import compute_statistics, evaluate_against_truth
from tracker.model import save_model
from tracker.synthesis.recording import RecordingOptions, write_recording
from tracker.synthesis.twin import load_twin
from tracker.tracking.follow import track_frames
from tracker.tracking.options import TrackOptions
from tracker.tracking.start import start_tracking
from tracker.tracking.track import join_chunks

TABLE = Path(__file__).resolve().parents[1] / "docs" / "accuracy_twins.md"
INTRODUCTION = """\
# Accuracy on twins

Rendered from the authors' models and motions with the noise of `docs/synthesis.md`, tracked with the same model,
started from the annotation of the first frame, one thread. Errors are means over the 21 joints of all frames; the
worst frame is the worst mean of one hand. Times are those of the machine it ran on. Made by `accuracy_twins.py` in
`benchmarks`.
"""
HEADER = (
    "| sequence | step | frames | mean px | mean mm | worst frame mm | lost | unnoticed | median ms |",
    "|---|---|---|---|---|---|---|---|---|",
)


def run(folder: Path, sequence: str, frames: int | None, step: int, seed: int) -> str:
    """Render, track and compare one sequence; its row of the table."""
    performance = load_twin(folder, sequence, 1500)
    last = performance.num_moments if frames is None else min(frames, performance.num_moments)
    with tempfile.TemporaryDirectory() as temporary:
        recording = Path(temporary) / sequence
        options = RecordingOptions(range(0, last, step), seed=seed)
        recorded = write_recording(performance, recording, options, save_model)
        models = {actor.name: actor.model for actor in performance.hands}
        annotations = load_annotations(recording / "annotations.json")
        how = TrackOptions(calibrate=False)
        setup, state = start_tracking(recorded, how, models, annotations)
        _, chunk = track_frames(recorded, setup, state, how.frame_range(recorded.frame_count))
        track = join_chunks(recorded, setup, [chunk])
        error = evaluate_against_truth(track, load_truth(recording / "truth.npz"))
    px, mm = compute_statistics(error.error_px), error.statistics_mm
    worst, median_ms = 1e3 * float(np.max(error.hand_mean)), 1e3 * float(np.median(track.seconds))
    return (
        f"| {sequence} | {step} | {len(error.frame)} | {px.mean:.2f} | {mm.mean:.2f} | {worst:.2f} | "
        f"{int(error.is_lost.sum())} | {int(error.is_silently_lost.sum())} | {median_ms:.1f} |"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--sequences", nargs="+", default=["09", "12"])
    parser.add_argument("--frames", type=int, help="the first so many frames only")
    parser.add_argument("--step", type=int, default=1)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--write", action="store_true", help=f"write the table to {TABLE.name} in docs")
    args = parser.parse_args()
    lines = [*HEADER, *(run(args.folder, name, args.frames, args.step, args.seed) for name in args.sequences)]
    print("\n".join(lines))
    if args.write:
        TABLE.write_text(f"{INTRODUCTION}\n" + "\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
