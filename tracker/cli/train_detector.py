"""`handloom train-detector`: a Hough forest that finds fingertips, or finger nails."""

from __future__ import annotations

import argparse
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tracker.cli.command import add_json, run_guarded
from tracker.cli.progress import ProgressLine
from tracker.errors import TrackerError

if TYPE_CHECKING:
    from tracker.capture.annotations import Annotations
    from tracker.capture.sequence import Sequence
    from tracker.detection.annotated_images import AnnotatedImage
    from tracker.detection.sampling import PatchOptions

WHATS = ("fingertips", "nails")
"""As `tracker.detection.forest` has them, which takes long to load."""

NAIL_BOX = 0.016
"""m, side of the box around a nail, which is 13 mm long at most."""

MAX_HELD_OUT = 300
"""Images that are kept aside, at most; more would not say more."""


def add_command(subparsers: argparse._SubParsersAction) -> None:
    parser = subparsers.add_parser(
        "train-detector",
        help="train a detector of fingertips or finger nails",
        description="Train the Hough forest that finds fingertips ([T16] section 3.2.5), or finger nails in colour "
        "views (section 3.3), from annotated recordings, recorded or rendered, and from images of random hands that "
        "are rendered for it.",
    )
    parser.add_argument(
        "recordings",
        type=Path,
        nargs="*",
        metavar="RECORDING",
        help="folders with annotated depth; for nails with annotated colour",
    )
    parser.add_argument("--what", choices=WHATS, default=WHATS[0], help="what it learns to find")
    parser.add_argument("--rendered", type=int, default=0, metavar="N", help="add N rendered images of random hands")
    parser.add_argument(
        "--test",
        type=Path,
        action="append",
        default=[],
        metavar="RECORDING",
        help="recordings to judge the detector on",
    )
    parser.add_argument("--on", choices=("depth", "color"), help="what the detector looks at (depth; nails: color)")
    parser.add_argument("--step", type=int, default=1, metavar="N", help="use one of N annotated images of a recording")
    parser.add_argument(
        "--no-skin", action="store_true", help="do not use colour to distinguish hands from other things"
    )
    parser.add_argument("--trees", type=int, default=10)
    parser.add_argument("--depth", type=int, default=25, help="depth of the deepest leaf")
    parser.add_argument("--min-leaf", type=int, default=20, help="patches in the smallest leaf")
    parser.add_argument("--tests", type=int, default=20_000, help="binary tests tried at a node; fewer train faster")
    parser.add_argument(
        "--patches", type=int, default=100_000, help="patches of each sort for a tree; fewer train faster"
    )
    parser.add_argument("--per-image", type=int, default=60, help="patches of each sort from an image")
    parser.add_argument("--pixel-size", type=float, metavar="MM", help="width of a pixel of a patch (3; nails: 1.5)")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--out", type=Path, required=True, metavar="FILE", help="the detector, .npz")
    parser.add_argument("--curve", type=Path, metavar="CSV", help="with --test: the precision-recall curve")
    add_json(parser)
    parser.set_defaults(run=run_guarded(train_detector, show))


def train_detector(args: argparse.Namespace) -> dict[str, Any]:
    import numpy as np

    from tracker.detection.confidence import calibrate_confidence
    from tracker.detection.forest_files import save_forest
    from tracker.detection.sampling import join_patches, sample_patches
    from tracker.detection.training import ForestOptions, train_forest
    from tracker.evaluation.detector_study import judge_detector

    _check(args)
    began = time.monotonic()
    about = _choose_patches(args)
    rng = np.random.default_rng(args.seed)
    parts, held_out, images = [], [], 0
    for item, is_kept_aside in _training_images(args):
        images += 1
        if not is_kept_aside:
            parts.append(sample_patches(item.image, item.tips, item.is_visible, about, rng))
        elif len(held_out) < MAX_HELD_OUT:
            held_out.append(item)
    if not parts:
        needed = "a marked hand in colour" if args.what == "nails" else "depth at the marked joints"
        raise TrackerError(f"Found no annotated image with {needed}; give other recordings.")
    patches = join_patches(parts)
    options = ForestOptions(
        trees=args.trees,
        depth=args.depth,
        min_leaf=args.min_leaf,
        tests=args.tests,
        patches=args.patches,
        box_size=NAIL_BOX if args.what == "nails" else ForestOptions.box_size,
        seed=args.seed,
        threads=args.threads,
    )
    line = ProgressLine(f"training on {len(patches)} patches")
    forest = replace(train_forest(patches, about, options, line.show), what=args.what)
    if held_out:
        curve = judge_detector(forest, held_out)
        forest = calibrate_confidence(forest, curve.confidences, curve.precision)
    args.out.parent.mkdir(parents=True, exist_ok=True)
    save_forest(forest, args.out)
    result = {
        "out": str(args.out),
        "what": args.what,
        "on": about.kind,
        "images": images,
        "patches": len(patches),
        "nodes": len(forest.nodes),
        "bytes": args.out.stat().st_size,
        "seconds": round(time.monotonic() - began, 1),
        "test": None,
    }
    if args.test:
        found = judge_detector(forest, _annotated(args.test, args, 1))
        if args.curve is not None:
            _write_curve(args.curve, found)
        precision, recall = found.at(3.0)
        result["test"] = {
            "images": found.num_images,
            args.what: found.num_truths,
            "auc": round(found.auc, 4),
            "precision_at_3": round(precision, 4),
            "recall_at_3": round(recall, 4),
        }
    return result


def show(result: dict[str, Any]) -> str:
    line = (
        f"{result['out']}: learnt from {result['patches']} patches of {result['images']} images, "
        f"{result['nodes']} nodes, {result['seconds']:.0f} s"
    )
    if result["test"] is not None:
        test = result["test"]
        what = result["what"]
        line += (
            f"\non {test[what]} visible {what} of {test['images']} test images: AUC {test['auc']:.3f}; "
            f"at confidence 3.0 precision {test['precision_at_3']:.3f}, recall {test['recall_at_3']:.3f}"
        )
    return line


def _check(args: argparse.Namespace) -> None:
    if not args.recordings and args.rendered < 1:
        raise TrackerError("Nothing to learn from: give recordings with annotations, --rendered N, or both.")
    for name in ("step", "trees", "depth", "min_leaf", "tests", "patches", "per_image", "threads"):
        if getattr(args, name) < 1:
            raise TrackerError(f"--{name.replace('_', '-')} is {getattr(args, name)}; it must be at least 1.")
    if args.rendered < 0 or args.seed < 0:
        raise TrackerError("--rendered and --seed must be at least 0.")
    if args.pixel_size is not None and not 0.5 <= args.pixel_size <= 20.0:
        raise TrackerError(f"--pixel-size is {args.pixel_size} mm; it must be from 0.5 to 20.")
    if args.what == "nails" and args.on == "depth":
        raise TrackerError(
            "Nails are not visible in depth images. Leave --on depth out, or train a detector of fingertips."
        )
    if args.curve is not None and not args.test:
        raise TrackerError("--curve needs --test RECORDING, the recordings that the curve is of.")


def _choose_patches(args: argparse.Namespace) -> PatchOptions:
    """Which patches of an image are learnt from."""
    from tracker.detection.sampling import PatchOptions

    if args.what == "nails":
        size = 1e-3 * (args.pixel_size or 1.5)
        reach = PatchOptions(positive_reach=0.012, negative_reach=0.018, hidden_reach=0.012)
        return replace(reach, kind="color", pixel_size=size, per_image=args.per_image)
    size = 1e-3 * (args.pixel_size or 3.0)
    return PatchOptions(kind=args.on or "depth", pixel_size=size, per_image=args.per_image)


def _training_images(args: argparse.Namespace) -> Iterator[tuple[AnnotatedImage, bool]]:
    """Images, and whether each is kept aside to say what confidences mean.

    Of a recording that is the end: of frames next to those that were learnt from a detector knows too much.
    """
    from tracker.detection.annotated_images import count_images
    from tracker.search.annotated_nails import count_nail_images

    count_them = count_nail_images if args.what == "nails" else count_images
    for folder in args.recordings:
        count = count_them(*_load(folder, args), args.step)
        for number, item in enumerate(_annotated([folder], args, args.step)):
            yield item, number >= 0.9 * count
    if args.rendered > 0:
        from tracker.synthesis.fingertip_images import render_fingertip_images
        from tracker.synthesis.nail_images import render_nail_images

        line = ProgressLine("rendering hands")
        render = render_nail_images if args.what == "nails" else render_fingertip_images
        for number, item in enumerate(render(args.rendered, args.seed)):
            yield item, number % 10 == 9
            line.show((number + 1) / args.rendered)


def _annotated(folders: list[Path], args: argparse.Namespace, step: int) -> Iterator[AnnotatedImage]:
    from tracker.detection.annotated_images import annotated_images
    from tracker.search.annotated_nails import annotated_nail_images

    for folder in folders:
        if args.what == "nails":
            yield from annotated_nail_images(*_load(folder, args), step)
            continue
        for item in annotated_images(*_load(folder, args), step, not args.no_skin):
            if args.on != "color" or item.image.color is not None:
                yield item


def _load(folder: Path, args: argparse.Namespace) -> tuple[Sequence, Annotations]:
    """A recording and its annotations, if fingertips or nails can be learnt from them."""
    from tracker.capture.annotations import load_annotations
    from tracker.capture.sequence import load_sequence

    sequence = load_sequence(folder)
    path = sequence.annotations_path
    if path is None or not path.exists():
        raise TrackerError(f"{folder}: has no annotations; mark hands in some of its frames first.")
    if args.what == "nails":
        if not any(camera.has_color for camera in sequence.cameras):
            raise TrackerError(f"{folder}: has no camera with colour; needed to see nails.")
        return sequence, load_annotations(path)
    cameras = [camera for camera in sequence.cameras if camera.has_depth]
    if not cameras:
        raise TrackerError(f"{folder}: has no camera with depth; needed for the size of patches.")
    if args.on == "color" and not any(camera.has_color for camera in cameras):
        raise TrackerError(f"{folder}: has no camera with both colour and depth; needed for --on color.")
    return sequence, load_annotations(path)


def _write_curve(path: Path, curve: Any) -> None:
    from tracker.capture.atomic_file import write_atomically

    rows = ["confidence,precision,recall"]
    rows += [
        f"{confidence:.6g},{precision:.6g},{recall:.6g}"
        for confidence, precision, recall in zip(curve.confidences, curve.precision, curve.recall, strict=True)
    ]
    path.parent.mkdir(parents=True, exist_ok=True)
    write_atomically(path, ("\n".join(rows) + "\n").encode())
