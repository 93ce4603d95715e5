"""T16's method as the paper has it, on a twin that is rendered and tracked with the authors' full meshes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from benchmarks.studies.twin_runs import find_first_motion, measure, render_twin, start_twin
from tracker.evaluation import evaluate_against_truth
from tracker.fitting.options import TrackOptions
from tracker.search.tools import make_tools
from tracker.terms.residual import Term
from tracker.tracking.as_written import CONTOURS, DATA_TERMS, follow_as_written
from tracker.tracking.chunk import TrackChunk
from tracker.tracking.track import join_chunks

M2D, D2M = "model_to_data", "data_to_model"
DATA: dict[str, dict[str, Term]] = {
    "both": DATA_TERMS,
    "m2d": {M2D: DATA_TERMS[M2D]},
    "d2m": {D2M: DATA_TERMS[D2M]},
    "any edge": DATA_TERMS | {D2M: replace(CONTOURS, max_angle=180.0)},
    "every pixel": DATA_TERMS | {D2M: replace(CONTOURS, at_vertices=False)},
}
"""The data terms, one of them alone, both without regard to the orientation of edges, or with every pixel of one."""

BLOCK = 10
"""Frames that are drawn together: the errors of frames that follow one another are alike."""

DRAWS = 4000


@dataclass(frozen=True)
class AsWritten:
    """The preset `t16` with some of its terms, from where something begins to move.

    Attributes:
        sequence: Of the public ones.
        terms: As `handloom track --terms` takes them.
        step: Every so many frames.
        data: One of DATA.
        frames: The first so many of the sequence; None is all.
        seed: Of the noise.
    """

    sequence: str
    terms: str
    step: int = 3
    data: str = "both"
    frames: int | None = None
    seed: int = 0

    def __call__(self, data: Path, twins: Path) -> dict[str, Any]:
        """Render, follow, measure."""
        cv2.setNumThreads(1)
        twin = render_twin(data, twins, self.sequence, self.frames, self.step, self.seed, None)
        options = TrackOptions(
            method="t16",
            terms=self.terms,
            calibrate=False,
            use_detector=False,
            first_frame=find_first_motion(twin),
        )
        setup, state = start_twin(twin, options)
        results = []
        with make_tools(setup, twin.sequence.camera(setup.camera_id).T_world_camera) as tools:
            for _ in options.frame_range(twin.sequence.frame_count):
                state, result = follow_as_written(twin.sequence, setup, tools, state, DATA[self.data])
                results.append(result)
        track = join_chunks(twin.sequence, setup, [TrackChunk.of(results)])
        error = evaluate_against_truth(track, twin.truth)
        by_frame = np.nanmean(error.error_px.reshape(len(error.frame), -1), axis=1)
        return {**measure(twin, track, penetration=True), "frame_px": by_frame.tolist()}


def compare(with_it: Sequence[dict[str, Any]], without: Sequence[dict[str, Any]]) -> tuple[float, float, float]:
    """Mean paired difference of the frames' errors, px, and its 95 % interval: blocks of frames are drawn anew.

    Frames count by their hands, as a mean over all joints of all frames has it.
    """
    blocks, weights = [], []
    for one, other in zip(with_it, without, strict=True):
        difference = np.array(one["frame_px"]) - np.array(other["frame_px"])
        for first in range(0, len(difference), BLOCK):
            part = difference[first : first + BLOCK]
            blocks.append(one["hands"] * float(part.sum()))
            weights.append(one["hands"] * len(part))
    sums, counts = np.array(blocks), np.array(weights, dtype=np.float64)
    chosen = np.random.default_rng(0).integers(len(sums), size=(DRAWS, len(sums)))
    means = sums[chosen].sum(axis=1) / counts[chosen].sum(axis=1)
    low, high = np.percentile(means, [2.5, 97.5])
    return float(sums.sum() / counts.sum()), float(low), float(high)
