"""Ours beside the particle swarm: `python benchmarks/against_swarm.py FOLDER [--sequence 09] [--frames 0:40]`.

FOLDER holds the authors' `Cameras.txt`, `models/` and `seq/`. Both trackers follow the same rendered twin with the
model it was rendered from, on one thread; the swarm starts where ours is after the first frame. At equal time the swarm
stops, on every frame, after the median time that ours took in this run.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Sequence as Several
from dataclasses import replace
from pathlib import Path

import numpy as np

from tracker.baselines import SwarmOptions, track_with_swarm
from tracker.capture.annotations import load_annotations
from tracker.capture.sequence import Sequence
from tracker.capture.truth import Truth, load_truth
from tracker.evaluation import compute_statistics, evaluate_against_truth
from tracker.model import save_model
from tracker.synthesis.recording import RecordingOptions, write_recording
from tracker.synthesis.twin import load_twin
from tracker.tracking.chunk import TrackChunk
from tracker.tracking.follow import track_frames
from tracker.tracking.options import TrackOptions
from tracker.tracking.setup import TrackSetup
from tracker.tracking.start import start_tracking
from tracker.tracking.track import join_chunks

HEADER = (
    "| tracker | mean px | max px | mean mm | worst frame mm | lost | generations | median ms |",
    "|---|---|---|---|---|---|---|---|",
)


def describe(name: str, sequence: Sequence, setup: TrackSetup, truth: Truth, chunks: Several[TrackChunk]) -> str:
    """A row of the table; several chunks are repetitions of the same run, of which the mean error is meant."""
    errors = [evaluate_against_truth(join_chunks(sequence, setup, [chunk]), truth) for chunk in chunks]
    px, mm = compute_statistics(np.stack([e.error_px for e in errors])), np.stack([e.error for e in errors])
    worst = 1e3 * max(float(np.max(e.hand_mean)) for e in errors)
    lost = " ".join(str(int(e.is_lost.sum())) for e in errors)
    iterations = np.median(np.concatenate([chunk.iterations for chunk in chunks]))
    median_ms = 1e3 * np.median(np.concatenate([chunk.seconds for chunk in chunks]))
    return (
        f"| {name} | {px.mean:.2f} | {px.max:.1f} | {1e3 * mm.mean():.2f} | {worst:.1f} | {lost} | "
        f"{iterations:.0f} | {median_ms:.1f} |"
    )


def compare(
    recorded: Sequence, setup: TrackSetup, start: np.ndarray, ours: TrackChunk, args: argparse.Namespace
) -> None:
    """Print the row of ours and those of all swarms."""
    truth = load_truth(recorded.folder / "truth.npz")
    frames = range(int(ours.frame[0]), int(ours.frame[-1]) + 1)
    seconds = float(np.median(ours.seconds))
    print(describe("ours (iterations)", recorded, setup, truth, [ours]), flush=True)
    for particles in args.particles:
        plain = SwarmOptions(particles=particles, generations=args.generations)
        for name, how in (
            (f"swarm, {particles} particles", plain),
            (f"swarm, {particles}, equal time", replace(plain, seconds_per_frame=seconds)),
        ):
            chunks = [
                track_with_swarm(recorded, setup, start, frames, replace(how, seed=seed)) for seed in range(args.repeat)
            ]
            print(describe(name, recorded, setup, truth, chunks), flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--sequence", default="09")
    parser.add_argument("--frames", default="0:40", help="FIRST:END[:STEP] of the sequence")
    parser.add_argument("--particles", type=int, nargs="+", default=[64, 128])
    parser.add_argument("--generations", type=int, default=40)
    parser.add_argument("--repeat", type=int, default=1, help="runs of each swarm with other random numbers; T16 has 3")
    parser.add_argument("--seed", type=int, default=0, help="of the sensor's noise")
    args = parser.parse_args()
    performance = load_twin(args.folder, args.sequence, 1500)
    wanted = range(performance.num_moments)[slice(*(int(part) if part else None for part in args.frames.split(":")))]
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary) / args.sequence
        recorded = write_recording(performance, folder, RecordingOptions(wanted, seed=args.seed), save_model)
        models = {actor.name: actor.model for actor in performance.actors}
        how = TrackOptions(calibrate=False)
        setup, state = start_tracking(recorded, how, models, load_annotations(folder / "annotations.json"))
        frames = how.frame_range(recorded.frame_count)
        _, warm = track_frames(recorded, setup, state, frames[:1])  # ours compiles, and settles, on its first frame
        _, chunk = track_frames(recorded, setup, state, frames)
        track_with_swarm(recorded, setup, warm.pose[0], frames[:1], SwarmOptions(particles=2, generations=1))
        print(f"sequence {args.sequence}, {len(frames)} frames, same model, {args.repeat} run(s) of each swarm\n")
        print("\n".join(HEADER))
        compare(recorded, setup, warm.pose[0], chunk, args)


if __name__ == "__main__":
    main()
