"""`handloom bench registration`: how long a scan takes, cold and warm, stage by stage."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from tracker.cli.command import add_json, run_guarded
from tracker.cli.progress import ProgressLine
from tracker.errors import TrackerError


def add_registration(subjects: argparse._SubParsersAction) -> None:
    parser = subjects.add_parser(
        "registration",
        help="where the time of a scan goes",
        description="Register generated scans of 50,000 points, cold (no start given, both sides tried) and warm (from "
        "the cold registration, as in a second round), and print medians of processor time by stage. Kernels are "
        "compiled before.",
    )
    parser.add_argument("--scans", type=int, default=20, metavar="N", help="how many (20)")
    parser.add_argument("--model", type=Path, metavar="FILE", help="the model for the warm runs (untrained hand)")
    add_json(parser)
    parser.set_defaults(run=run_guarded(bench, show))


def bench(args: argparse.Namespace) -> dict[str, Any]:
    import numpy as np

    from tracker.cli.register import find_registrar
    from tracker.synthesis.scans.generate import ScanOptions, generate_scan
    from tracker.synthesis.scans.pose_list import POSE_NAMES
    from tracker.synthesis.scans.subject import TEST_SUBJECTS

    if not 1 <= args.scans <= 1000:
        raise TrackerError(f"--scans {args.scans}: needed 1 to 1000.")
    untrained, learned = find_registrar(None), find_registrar(args.model)
    line = ProgressLine("bench registration")
    rng = np.random.default_rng(0)
    runs: dict[str, list[dict[str, float]]] = {"cold": [], "warm": []}
    right = 0
    for number in range(args.scans + 1):
        subject = int(TEST_SUBJECTS[int(rng.integers(len(TEST_SUBJECTS)))])
        pose, side = int(rng.integers(len(POSE_NAMES))), ("right", "left")[int(rng.integers(2))]
        made = generate_scan(subject, pose, side, number, ScanOptions(has_forearm=bool(rng.integers(2))))
        cold = untrained.register(made.scan)
        warm = learned.register(made.scan, start=cold.as_start())
        if number:  # the first one compiles and prepares the models
            errors = np.linalg.norm(cold.vertices - made.true_vertices, axis=1)
            right += int(cold.side == side and np.percentile(errors, 95) < 0.010)
            runs["cold"].append(cold.timings)
            runs["warm"].append(warm.timings)
        line.show((number + 1) / (args.scans + 1))
    result: dict[str, Any] = {name: _summarize(found) for name, found in runs.items()}
    return result | {"scans": args.scans, "points": 50_000, "right": right}


def _summarize(runs: list[dict[str, float]]) -> dict[str, Any]:
    import numpy as np

    totals = [sum(stages.values()) for stages in runs]
    return {
        "median_s": round(float(np.median(totals)), 3),
        "p95_s": round(float(np.percentile(totals, 95)), 3),
        "stages_s": {name: round(float(np.median([stages[name] for stages in runs])), 3) for name in runs[0]},
    }


def show(result: dict[str, Any]) -> str:
    lines = [f"{result['scans']} scans of {result['points']} points, {result['right']} of them right"]
    for name in ("cold", "warm"):
        found = result[name]
        stages = ", ".join(f"{stage} {seconds:.2f}" for stage, seconds in found["stages_s"].items())
        lines.append(f"{name}: median {found['median_s']:.2f} s a scan (p95 {found['p95_s']:.2f}); {stages}")
    return "\n".join(lines)
