"""Our own hand on T16's twins, calibrated from the first two seconds, by sequence and by joint.

    python -m benchmarks.studies.own_hand DATA [--sequences 09 15] [--steps 1 3] [--twins FOLDER] [--noise-px 1.5]
                                          [--hand FILE]

DATA holds the authors' `Cameras.txt`, `models/` and `seq/`. Every run starts from the annotation of its first frame and
sees no other; `--noise-px` moves its marks as different annotators would. `--hand` takes another hand in place of the
default one: any file that `handloom track --hand` takes, mirrored where the other side is needed.
"""

from __future__ import annotations

import argparse
import os
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ.setdefault(name, "1")  # before numpy

import numpy as np  # noqa: E402

from benchmarks.studies.twin_runs import SEQUENCES, Twin, measure, render_twin, run_twin  # noqa: E402
from tracker.capture.annotations import Annotations, load_annotations  # noqa: E402
from tracker.evaluation import evaluate_against_truth  # noqa: E402
from tracker.fitting.options import TrackOptions  # noqa: E402
from tracker.model import load_model, mirror  # noqa: E402
from tracker.model.articulated import ArticulatedModel  # noqa: E402
from tracker.model.joints import HAND_JOINTS  # noqa: E402
from tracker.tracking.start import start_tracking  # noqa: E402

TUNED_ON = ("09", "15")
BAR_PX, BAR_MM = 2.5, 4.0


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data", type=Path)
    parser.add_argument("--sequences", nargs="+", choices=SEQUENCES, default=SEQUENCES, metavar="NN")
    parser.add_argument("--steps", nargs="+", type=int, default=[1, 3], help="every frame, every 3rd (1 3)")
    parser.add_argument("--terms", default="LO", help="of the run (LO)")
    parser.add_argument("--noise-px", type=float, default=0.0, help="standard deviation of the marks (0)")
    parser.add_argument("--hand", type=Path, metavar="FILE", help="a model in place of the default hand")
    parser.add_argument("--twins", type=Path, default=Path("out") / "studies" / "twins", help="cache of rendered twins")
    args = parser.parse_args()
    hands = {} if args.hand is None else load_both(args.hand)
    print("| sequence | every | tuned on | px | mm | moving px | worst frame, mm | lost | start, s | bar |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    by_joint: dict[str, list[np.ndarray]] = {}
    is_met = True
    for step in args.steps:
        for name in args.sequences:
            twin = render_twin(args.data, args.twins, name, None, step, 0)
            found, joints = run(twin, args.terms, args.noise_px, hands)
            by_joint[f"{name}/{step}"] = joints
            met = found["px"] <= BAR_PX and found["mm"] <= BAR_MM and found["lost"] == 0
            is_met &= met
            print(
                f"| {name} | {step} | {'yes' if name in TUNED_ON else 'no'} | {found['px']:.2f} | {found['mm']:.2f} | "
                f"{found['moving_px']:.2f} | {found['worst_mm']:.1f} | {found['lost']} | {found['start_s']:.1f} | "
                f"{'met' if met else '**not met**'} |",
                flush=True,
            )
    print("\nMean distance of each joint, mm (px):\n")
    print(f"| joint | {' | '.join(by_joint)} |\n|---|{'---|' * len(by_joint)}")
    for number, joint in enumerate(HAND_JOINTS):
        cells = [f"{mm[number]:.1f} ({px[number]:.1f})" for px, mm in by_joint.values()]
        print(f"| {joint} | {' | '.join(cells)} |")
    return 0 if is_met else 1


def load_both(path: Path) -> dict[str, ArticulatedModel]:
    """The hand of a file and its mirror image, by side."""
    model = load_model(path)
    if model.hand is None:
        raise SystemExit(f"{path}: holds no hand.")
    other = mirror(model)
    assert other.hand is not None
    return {model.hand.side: model, other.hand.side: other}


def run(
    twin: Twin, terms: str, noise_px: float, hands: dict[str, ArticulatedModel]
) -> tuple[dict[str, Any], list[np.ndarray]]:
    """The figures of one run, and (21,) px and (21,) mm of each joint, hands together."""
    annotations = _first_only(load_annotations(twin.sequence.folder / "annotations.json"), noise_px)
    models = {actor.name: actor.model for actor in twin.performance.objects}
    models |= {side: model for side, model in hands.items() if side in twin.sequence.hands}
    began = time.perf_counter()
    setup, state = start_tracking(twin.sequence, TrackOptions(terms=terms), models, annotations)
    seconds = time.perf_counter() - began
    track = run_twin(twin, setup, state)
    error = evaluate_against_truth(track, twin.truth)
    px, mm = np.nanmean(error.error_px, axis=(0, 1, 2)), 1e3 * error.error.mean(axis=(0, 1))
    return {**measure(twin, track), "start_s": seconds}, [px, mm]


def _first_only(annotations: Annotations, noise_px: float) -> Annotations:
    """Those of frame 0, each mark moved by the noise."""
    rng = np.random.default_rng(0)
    items = []
    for item in annotations.items:
        if item.frame == 0:
            points = np.array(item.points, dtype=np.float64)
            points[:, :2] += noise_px * rng.normal(size=(len(points), 2))
            items.append(replace(item, points=points))
    return Annotations(tuple(items))


if __name__ == "__main__":
    raise SystemExit(main())
