"""`handloom train-model`: a hand model from registrations."""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path
from typing import Any

from tracker.cli.command import add_json, run_guarded
from tracker.cli.progress import ProgressLine
from tracker.errors import TrackerError


def add_command(subparsers: argparse._SubParsersAction) -> None:
    parser = subparsers.add_parser(
        "train-model",
        help="train a hand model from registrations",
        description="Learn template, shapes, blend weights, joints and pose blend shapes of a hand ([R17] section 3.3) "
        "from registrations, as `handloom register` writes them: from those whose verdict is good, or those of a list. "
        "Beside the model, FILE.json says what it was learnt from and how well it fits. Every stage is kept in "
        "FILE.stages until the model is written: a stopped training continues when it is started again.",
    )
    parser.add_argument("registrations", type=Path, metavar="DIR", help="the folder with the registrations")
    parser.add_argument("--out", type=Path, required=True, metavar="FILE", help="the model, .npz")
    add_training_options(parser)
    parser.add_argument("--initial", type=Path, metavar="FILE", help="the model they were registered with (untrained)")
    parser.add_argument("--name", default="trained hand", help="name of the model")
    add_json(parser)
    parser.set_defaults(run=run_guarded(train_model_command, show))


def add_training_options(parser: argparse.ArgumentParser) -> None:
    """What `train-model` and `model-loop` share."""
    parser.add_argument(
        "--accepted", type=Path, metavar="FILE", help="a file with the names of accepted scans, a JSON list or lines"
    )
    parser.add_argument("--rounds-of-training", type=int, default=3, metavar="N", help="rounds of training (3)")
    parser.add_argument("--shapes", type=int, default=10, metavar="N", help="shape directions of the whole hand (10)")
    parser.add_argument(
        "--local-shapes", type=int, default=0, metavar="N", help="shape directions of parts of the hand (0)"
    )
    parser.add_argument("--no-pose-shapes", action="store_true", help="plain linear blend skinning")
    parser.add_argument("--no-mirrored", action="store_true", help="learn from right hands only")
    parser.add_argument("--threads", type=int, default=2, metavar="N", help="poses fitted at a time (2)")


def train_model_command(args: argparse.Namespace) -> dict[str, Any]:
    from tracker.model.blend_files import load_blend_model
    from tracker.model.untrained_hand import untrained_hand

    if args.out.suffix != ".npz":
        raise TrackerError(f"{args.out}: the model is written as .npz; give such a name.")
    initial = load_blend_model(args.initial) if args.initial else untrained_hand("right")
    return train_from(args.registrations, initial, args.out, args.name, read_accepted(args.accepted), args)


def train_from(folder: Path, initial, out: Path, name: str, accepted: set[str] | None, args) -> dict[str, Any]:
    """Train from a folder of registrations, write the model and its report, and return what `--json` prints."""
    from tracker.capture.atomic_file import write_atomically
    from tracker.model.blend_files import save_blend_model
    from tracker.training.checkpoints import FolderCheckpoints
    from tracker.training.options import TrainingOptions
    from tracker.training.stages import list_stages
    from tracker.training.train import train_model
    from tracker.training.training_set import load_training_set

    training_set = load_training_set(folder, accepted)
    options = TrainingOptions(
        name=name,
        rounds=args.rounds_of_training,
        num_shapes=args.shapes,
        num_local_shapes=args.local_shapes,
        with_pose_shapes=not args.no_pose_shapes,
        with_mirrored=not args.no_mirrored,
        threads=args.threads,
    )
    began = time.monotonic()
    line = ProgressLine(f"training on {len(training_set)} registrations")
    kept = FolderCheckpoints(out.with_suffix(".stages"))
    training = train_model(training_set, initial, options, lambda stage, share: line.show(share, stage), kept)
    out.parent.mkdir(parents=True, exist_ok=True)
    save_blend_model(training.model, out)
    write_atomically(out.with_suffix(".json"), json.dumps(training.report, indent=1).encode())
    kept.remove(list_stages(options.rounds))
    told = ("registrations", "people", "hands", "residual_mm", "joint_regressor_mm")
    return {
        "out": str(out),
        "report": str(out.with_suffix(".json")),
        "training_set": training_set.digest,
        **{key: training.report[key] for key in told},
        "seconds": round(time.monotonic() - began, 1),
    }


def read_accepted(path: Path | None) -> set[str] | None:
    """Names of scans from a JSON list, from {"name": "accepted" | ...}, or from lines.

    Raises:
        TrackerError: It is none of these.
    """
    if path is None:
        return None
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise TrackerError(f"{path}: no readable text ({error}).") from error
    if not text.lstrip().startswith(("[", "{")):
        return {line.strip() for line in text.splitlines() if line.strip()}
    try:
        found = json.loads(text)
    except (json.JSONDecodeError, RecursionError) as error:
        raise TrackerError(f"{path}: no JSON ({error}).") from error
    if isinstance(found, dict):
        found = [name for name, decision in found.items() if decision == "accepted"]
    if not all(isinstance(name, str) for name in found):
        raise TrackerError(f"{path}: needed a list of names of scans.")
    return set(found)


def show(result: dict[str, Any]) -> str:
    return (
        f"{result['out']}: learnt from {result['registrations']} registrations of {result['hands']} hands of "
        f"{result['people']} people in {result['seconds']:.0f} s; lies {result['residual_mm']:.2f} mm from them "
        f"(root mean square); {result['report']} says more"
    )
