"""`handloom warm-up`: compile every kernel now, so that later runs do not wait."""

from __future__ import annotations

import argparse
import time
from typing import Any

from tracker.cli.command import add_json, run_guarded
from tracker.cli.progress import ProgressLine


def add_command(subparsers: argparse._SubParsersAction) -> None:
    parser = subparsers.add_parser(
        "warm-up",
        help="compile the tracker's kernels",
        description="Compile the tracker's kernels and keep them on disk, which the first run would otherwise do.",
    )
    add_json(parser)
    parser.set_defaults(run=run_guarded(compile_kernels, show))


def compile_kernels(args: argparse.Namespace) -> dict[str, Any]:
    from tracker.evaluation.surface_distance import warm_up_distances
    from tracker.registration.warm_up import warm_up_registration
    from tracker.tracking.warm_up import warm_up
    from tracker.training.warm_up import warm_up_training

    began = time.monotonic()
    line = ProgressLine("compiling kernels")
    warm_up(lambda stage, share: line.show(0.6 * share, stage))
    line.show(0.6, "compiling the registration")
    warm_up_registration()
    line.show(0.8, "compiling the training")
    warm_up_training()
    line.show(0.95, "compiling the distances")
    warm_up_distances()
    line.show(1.0)
    return {"seconds": round(time.monotonic() - began, 2)}


def show(result: dict[str, Any]) -> str:
    return f"kernels are compiled ({result['seconds']:.1f} s)"
