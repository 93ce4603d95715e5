"""Ours and the particle swarm on one twin, in one run: model, renderer, images and start are the same."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.baselines import SwarmOptions, track_with_swarm
from benchmarks.studies.twin_runs import Twin, find_first_motion, render_twin, start_twin
from tracker.evaluation import compute_statistics, evaluate_against_truth
from tracker.fitting.options import TrackOptions
from tracker.fitting.setup import TrackSetup
from tracker.tracking.chunk import TrackChunk
from tracker.tracking.follow import track_frames
from tracker.tracking.track import join_chunks


@dataclass(frozen=True)
class AgainstSwarm:
    """The first frames of a twin in which something moves, followed by ours and by swarms.

    The swarm starts where ours is after the first frame. At equal time it stops, on every frame, after the median time
    that ours took in this run.

    Attributes:
        sequence: Of the public ones.
        step: Every so many frames of it.
        tracked: So many of those.
        settings: Generations and particles of each swarm.
        at_equal_time: Particles of the swarms that have as long as ours.
        repeats: Runs of each swarm with other random numbers.
        seed: Of the sensor's noise.
    """

    sequence: str
    step: int
    tracked: int
    settings: tuple[tuple[int, int], ...]
    at_equal_time: tuple[int, ...]
    repeats: int
    seed: int = 0

    def __call__(self, data: Path, twins: Path) -> dict[str, Any]:
        """Track and compare: a row for ours and one for each swarm."""
        twin = render_twin(data, twins, self.sequence, None, self.step, self.seed)
        first = find_first_motion(twin)
        setup, state = start_twin(twin, TrackOptions(terms="LO+SC", calibrate=False, first_frame=first))
        frames = range(first, min(first + self.tracked, twin.sequence.frame_count))
        _, warm = track_frames(
            twin.sequence, setup, state, frames[:1]
        )  # ours compiles, and settles, on its first frame
        _, ours = track_frames(twin.sequence, setup, state, frames)
        start, seconds = warm.pose[0], float(np.median(ours.seconds))
        track_with_swarm(twin.sequence, setup, start, frames[:1], SwarmOptions(particles=2, generations=1))
        rows = [{"tracker": "ours", **describe(twin, setup, [ours])}]
        swarms = [
            (f"{generations} x {particles}", SwarmOptions(particles=particles, generations=generations))
            for generations, particles in self.settings
        ] + [
            (f"equal time, {particles}", SwarmOptions(particles=particles, seconds_per_frame=seconds))
            for particles in self.at_equal_time
        ]
        for name, how in swarms:
            chunks = [
                track_with_swarm(twin.sequence, setup, start, frames, replace(how, seed=seed))
                for seed in range(self.repeats)
            ]
            rows.append({"tracker": name, **describe(twin, setup, chunks)})
        return {"rows": rows}


def describe(twin: Twin, setup: TrackSetup, chunks: Sequence[TrackChunk]) -> dict[str, Any]:
    """What a tracker attained; several chunks are repetitions, over all of which the figures go."""
    errors = [evaluate_against_truth(join_chunks(twin.sequence, setup, [chunk]), twin.truth) for chunk in chunks]
    px = compute_statistics(np.stack([error.error_px for error in errors]))
    return {
        "frames": len(errors[0].frame),
        "px": px.mean,
        "px_std": px.std,
        "px_max": px.max,
        "each_px": [float(np.nanmean(error.error_px)) for error in errors],
        "mm": 1e3 * float(np.mean([error.error.mean() for error in errors])),
        "worst_mm": 1e3 * max(float(np.max(error.hand_mean)) for error in errors),
        "lost": int(sum(error.is_lost.sum() for error in errors)),
        "generations": float(np.median(np.concatenate([chunk.iterations for chunk in chunks]))),
        "median_ms": 1e3 * float(np.median(np.concatenate([chunk.seconds for chunk in chunks]))),
    }
