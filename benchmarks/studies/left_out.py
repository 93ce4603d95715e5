"""Does each term of ours keep its place? Each left out, with our own hand, whose mesh is not the rendered one.

    python -m benchmarks.studies.left_out FOLDER_OF_T16_DATA --cache FOLDER

The hand is calibrated once a sequence, with all terms; then every third frame is followed with and without each term.
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from benchmarks.studies.as_written import compare
from benchmarks.studies.study import SETTING_STEP
from benchmarks.studies.twin_runs import Twin, render_twin, start_twin
from tracker.evaluation import evaluate_against_truth
from tracker.fitting.objective import Objective
from tracker.fitting.options import TrackOptions
from tracker.fitting.setup import TrackSetup
from tracker.search.tools import make_tools
from tracker.terms.data_to_model import DataToModel
from tracker.terms.residual import Term
from tracker.tracking.chunk import TrackChunk
from tracker.tracking.follow import follow_frame
from tracker.tracking.state import TrackState
from tracker.tracking.track import join_chunks

NAMES = ("20", "09", "04", "15", "01")
LEFT_OUT = (
    ("data_to_surface",),
    ("uncovered",),
    ("silhouette",),
    ("data_to_model",),
    ("model_to_data",),
    ("silhouette", "data_to_model"),
    ("silhouette", "model_to_data"),
    ("silhouette", "data_to_model", "model_to_data"),
)
ANY_EDGE = DataToModel(weight=0.02, max_angle=180.0)


def list_variants() -> dict[str, dict[str, Term]]:
    """What is left out to the terms that remain; the first is all of them."""
    terms = Objective().terms
    without = {", ".join(names): {n: t for n, t in terms.items() if n not in names} for names in LEFT_OUT}
    return {"nothing": terms, **without, "orientation of edges": terms | {"data_to_model": ANY_EDGE}}


def follow_with(terms: dict[str, Term], twin: Twin, setup: TrackSetup, state: TrackState) -> dict[str, Any]:
    """Hands, and the mean error of each frame, px, of a run with these terms and C."""
    results = []
    with make_tools(setup, twin.sequence.camera(setup.camera_id).T_world_camera) as made:
        both = {**terms, "collision": made.objective.terms["collision"]}
        tools = replace(made, objective=replace(made.objective, terms=both))
        for _ in setup.options.frame_range(twin.sequence.frame_count):
            state, result = follow_frame(twin.sequence, setup, tools, state, recover=True)
            results.append(result)
    track = join_chunks(twin.sequence, setup, [TrackChunk.of(results)])
    error = evaluate_against_truth(track, twin.truth)
    by_frame = np.nanmean(error.error_px.reshape(len(error.frame), -1), axis=1)
    return {"hands": len(error.hands), "frame_px": by_frame.tolist()}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data", type=Path, help="the authors' folder")
    parser.add_argument("--cache", type=Path, default=Path("twins"), help="where twins are rendered to")
    parser.add_argument("--names", nargs="+", default=NAMES, help="sequences")
    parser.add_argument("--frames", type=int, help="of each sequence the first so many")
    arguments = parser.parse_args()
    cv2.setNumThreads(1)
    found: dict[str, list[dict[str, Any]]] = {what: [] for what in list_variants()}
    for name in arguments.names:
        twin = render_twin(arguments.data, arguments.cache, name, arguments.frames, SETTING_STEP, 0)
        setup, state = start_twin(twin, TrackOptions(terms="LO+C", use_detector=False), own_hand=True)
        for what, terms in list_variants().items():
            found[what].append(follow_with(terms, twin, setup, state))
    print("| left out | all | 95 % | " + " | ".join(arguments.names) + " |\n|" + "---|" * (3 + len(arguments.names)))
    for what, runs in found.items():
        mean, low, high = compare(found["nothing"], runs)
        each = (compare([one], [other])[0] for one, other in zip(found["nothing"], runs, strict=True))
        print(f"| {what} | {mean:+.3f} | {low:+.3f} to {high:+.3f} | " + " | ".join(f"{px:+.3f}" for px in each) + " |")


if __name__ == "__main__":
    main()
