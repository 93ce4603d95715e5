"""`handloom synthesize-bodies`: scans of people with exactly known truth, still or moving."""

from __future__ import annotations

import argparse
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

from tracker.cli.command import add_json, run_guarded
from tracker.cli.progress import ProgressLine
from tracker.errors import TrackerError, say_count


def add_command(subparsers: argparse._SubParsersAction) -> None:
    parser = subparsers.add_parser(
        "synthesize-bodies",
        help="make scans of people with known truth, still or moving",
        description="Make scans of whole people with their hands. OUT gets a PLY and OUT/truth an npz for each. Scans "
        "that are there already are kept: an interrupted run continues where it stopped.",
    )
    parser.add_argument("--out", type=Path, required=True, metavar="DIR")
    parser.add_argument(
        "--people", type=int, default=10, metavar="N", help="number of people, each in another pose (10)"
    )
    parser.add_argument("--first", type=int, default=0, metavar="N", help="number of the first person (0)")
    parser.add_argument("--seed", type=int, default=0, help="seed of the poses (0)")
    parser.add_argument(
        "--frames", type=int, default=0, metavar="N", help="make this many scans of the first person in motion"
    )
    parser.add_argument("--points", type=int, default=150_000, metavar="N", help="points of a scan (150000)")
    parser.add_argument(
        "--noise-mm", type=float, default=0.5, metavar="MM", help="standard deviation of the noise, mm (0.5)"
    )
    parser.add_argument(
        "--missing",
        type=float,
        default=None,
        metavar="SHARE",
        help="share of hands that are missing (0), or of a motion's frames (0.2)",
    )
    add_json(parser)
    parser.set_defaults(run=run_guarded(synthesize_bodies, show))


def synthesize_bodies(args: argparse.Namespace) -> dict[str, Any]:
    from tracker.synthesis.bodies.body_set import write_motion, write_people
    from tracker.synthesis.bodies.generate import BODY_SCANNER, BodyScanOptions
    from tracker.synthesis.bodies.moving import MovingOptions, make_motion

    is_moving = args.frames > 0
    missing = args.missing if args.missing is not None else (0.2 if is_moving else 0.0)
    checks = {
        "--people": (args.people, 1, 100_000),
        "--first": (args.first, 0, 2**31),
        "--seed": (args.seed, 0, 2**31),
        "--frames": (args.frames, 0, 100_000),
        "--points": (args.points, 100, 1_000_000),
        "--noise-mm": (args.noise_mm, 0.0, 20.0),
        "--missing": (missing, 0.0, 1.0),
    }
    for name, (value, least, most) in checks.items():
        if not least <= value <= most:
            raise TrackerError(f"{name} is {value}; needed {least:g} to {most:g}.")
    if args.out.exists() and not args.out.is_dir():
        raise TrackerError(f"{args.out} is a file; needed a folder.")
    scanner = replace(BODY_SCANNER, num_points=args.points, noise=1e-3 * args.noise_mm)
    began = time.monotonic()
    if is_moving:
        line = ProgressLine(f"scanning {say_count(args.frames, 'frame')}")
        moving = make_motion(args.first, args.frames, args.seed, MovingOptions(missing=missing))
        paths = write_motion(moving, args.out, scanner, line.show)
    else:
        line = ProgressLine(f"scanning {say_count(args.people, 'person', 'people')}")
        numbers = list(range(args.first, args.first + args.people))
        options = BodyScanOptions(scanner, missing_hands=missing)
        paths = write_people(numbers, args.out, args.seed, options, line.show)
    return {"out": str(args.out), "scans": len(paths), "seconds": round(time.monotonic() - began, 2)}


def show(result: dict[str, Any]) -> str:
    return f"{say_count(result['scans'], 'scan')} in {result['out']} ({result['seconds']:.1f} s)"
