"""Make the fingertip detector that comes with Handloom: `python scripts/build_detector.py [--out FILE]`.

It learns from renders of the default hand alone: random people, poses and views, one or two hands, things in and near
them, the noise of `docs/recordings.md`. A second set of renders says what its confidences mean and how good it is.
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path

import numpy as np

from tracker.detection.confidence import calibrate_confidence
from tracker.detection.default_detector import DATA
from tracker.detection.forest_files import save_forest
from tracker.detection.sampling import PatchOptions, join_patches, sample_patches
from tracker.detection.training import ForestOptions, train_forest
from tracker.evaluation.detector_study import judge_detector
from tracker.synthesis.fingertip_images import render_fingertip_images

SEED = 20160


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=DATA)
    parser.add_argument("--images", type=int, default=4000, help="to learn from")
    parser.add_argument("--held-out", type=int, default=300, help="to calibrate confidences with")
    parser.add_argument("--patches", type=int, default=60_000, help="of each sort, for each tree")
    parser.add_argument("--tests", type=int, default=6_000, help="at each node")
    parser.add_argument("--threads", type=int, default=2)
    args = parser.parse_args()
    began = time.monotonic()
    about = PatchOptions()
    rng = np.random.default_rng(SEED)
    images = render_fingertip_images(args.images, SEED)
    patches = join_patches([sample_patches(i.image, i.tips, i.is_visible, about, rng) for i in images])
    print(f"{len(patches)} patches of {args.images} images after {time.monotonic() - began:.0f} s", flush=True)
    options = ForestOptions(patches=args.patches, tests=args.tests, seed=SEED, threads=args.threads)
    forest = train_forest(patches, about, options, lambda share: print(f"{100 * share:.0f} %", flush=True))
    held_out = list(render_fingertip_images(args.held_out, SEED + 1))
    curve = judge_detector(forest, held_out)
    forest = calibrate_confidence(forest, curve.confidences, curve.precision)
    save_forest(forest, args.out)
    size = args.out.stat().st_size / 1e6
    print(
        f"{args.out}: {len(forest.nodes)} nodes, {size:.2f} MB; AUC on held-out renders {curve.auc:.3f}; "
        f"{time.monotonic() - began:.0f} s"
    )


if __name__ == "__main__":
    main()
