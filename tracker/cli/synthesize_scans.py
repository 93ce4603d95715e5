"""`handloom synthesize-scans`: scans of hands with exactly known truth, to try registration and training with."""

from __future__ import annotations

import argparse
import re
import time
from pathlib import Path
from typing import Any

from tracker.cli.command import add_json, run_guarded
from tracker.cli.progress import ProgressLine
from tracker.errors import TrackerError, say_count


def add_command(subparsers: argparse._SubParsersAction) -> None:
    parser = subparsers.add_parser(
        "synthesize-scans",
        help="make scans of hands with known truth",
        description="Make scans of hands of 37 people in 51 poses, whose true surface no blend model can represent. "
        "OUT/scans gets a PLY and OUT/truth an npz for each, OUT/scans.json lists them. Scans that are there already "
        "are kept, so an interrupted run continues.",
    )
    parser.add_argument("--out", type=Path, required=True, metavar="DIR")
    parser.add_argument(
        "--subjects", default="train", metavar="LIST", help="train, test, all, or numbers such as 1,4,20-25 (train)"
    )
    parser.add_argument(
        "--poses", default="all", metavar="LIST", help="all, fists, or names such as fist,tip_pinch (all)"
    )
    parser.add_argument(
        "--motions",
        type=Path,
        metavar="FOLDER",
        help="T16's models and motions; then 09-60 is a pose too: frame 60 of sequence 09",
    )
    parser.add_argument("--sides", default="right,left", metavar="LIST", help="right, left or right,left (both)")
    parser.add_argument("--repeats", type=int, default=1, metavar="N", help="scans of each pose (1)")
    parser.add_argument("--seed", type=int, default=0, help="seed of the first repetition (0)")
    parser.add_argument("--points", type=int, default=50_000, metavar="N", help="points of a scan (50000)")
    parser.add_argument(
        "--noise-mm", type=float, default=0.2, metavar="MM", help="standard deviation of the noise, mm (0.2)"
    )
    parser.add_argument(
        "--strength", type=float, default=1.0, metavar="X", help="strength of swelling and sliding skin (1)"
    )
    parser.add_argument(
        "--forearm",
        choices=("yes", "no", "half"),
        default="yes",
        help="forearm in all scans, in none, or in every second one",
    )
    parser.add_argument("--objects", action="store_true", help="put a green object into grasps")
    parser.add_argument("--surfaces", action="store_true", help="keep the true surface of every scan too")
    add_json(parser)
    parser.set_defaults(run=run_guarded(synthesize_scans, show))


def synthesize_scans(args: argparse.Namespace) -> dict[str, Any]:
    from tracker.synthesis.scans.generate import ScanOptions
    from tracker.synthesis.scans.scan_set import ScanSet, write_scan_set
    from tracker.synthesis.scans.scanner import Scanner

    checks = {
        "--repeats": (args.repeats, 1, 1000),
        "--seed": (args.seed, 0, 2**31),
        "--points": (args.points, 100, 200_000),
        "--noise-mm": (args.noise_mm, 0.0, 5.0),
        "--strength": (args.strength, 0.0, 4.0),
    }
    for name, (value, least, most) in checks.items():
        if not least <= value <= most:
            raise TrackerError(f"{name} is {value}; needed {least} to {most}.")
    scanner = Scanner(num_points=args.points, noise=1e-3 * args.noise_mm)
    options = ScanOptions(scanner, args.strength, args.objects, has_forearm=args.forearm != "no")
    wanted = ScanSet(
        parse_subjects(args.subjects),
        parse_poses(args.poses, args.motions is not None),
        parse_sides(args.sides),
        args.repeats,
        args.seed,
        options,
        args.forearm == "half",
        args.surfaces,
        "" if args.motions is None else str(args.motions.resolve()),
    )
    began = time.monotonic()
    line = ProgressLine(f"scanning {len(wanted)} hands")
    rows = write_scan_set(wanted, args.out, line.show)
    return {"out": str(args.out), "scans": len(rows), "seconds": round(time.monotonic() - began, 2)}


def show(result: dict[str, Any]) -> str:
    return f"{say_count(result['scans'], 'scan')} in {result['out']} ({result['seconds']:.1f} s)"


def parse_subjects(text: str) -> tuple[int, ...]:
    """`train`, `test`, `all`, or numbers and ranges of them."""
    from tracker.synthesis.scans.subject import TEST_SUBJECTS, TRAIN_SUBJECTS

    everybody = (*TRAIN_SUBJECTS, *TEST_SUBJECTS)
    named = {"train": TRAIN_SUBJECTS, "test": TEST_SUBJECTS, "all": everybody}
    if text in named:
        return named[text]
    numbers: list[int] = []
    for word in text.split(","):
        first, dash, last = word.strip().partition("-")
        if not first.isdecimal() or (dash and not (last.isdecimal() and int(first) <= int(last))):
            raise TrackerError(f"--subjects {text!r}: needed train, test, all, or numbers such as 1,4,20-25.")
        numbers += range(int(first), min(int(last or first), 10_000) + 1)
        if len(numbers) > len(everybody) or not set(numbers) <= set(everybody):
            raise TrackerError(f"--subjects {text!r}: there are the subjects 1 to {len(everybody)}, each once.")
    return tuple(dict.fromkeys(numbers))


def parse_poses(text: str, has_motions: bool) -> tuple[str, ...]:
    """`all`, `fists`, or names; `09-60` is frame 60 of a motion."""
    from tracker.synthesis.scans.pose_list import FISTS, POSE_NAMES

    if text in ("all", "fists"):
        return POSE_NAMES if text == "all" else FISTS
    names = tuple(dict.fromkeys(word.strip() for word in text.split(",")))
    unknown = [name for name in names if name not in POSE_NAMES and not re.fullmatch(r"[0-9]{1,3}-[0-9]{1,6}", name)]
    if not has_motions and not unknown and not set(names) <= set(POSE_NAMES):
        raise TrackerError(f"--poses {text!r}: frames of motions need --motions FOLDER, T16's models and motions.")
    if unknown:
        raise TrackerError(f"There is no pose {unknown[0]!r}; there are {', '.join(POSE_NAMES)}.")
    return names


def parse_sides(text: str) -> tuple[str, ...]:
    sides = tuple(dict.fromkeys(word.strip() for word in text.split(",")))
    if not set(sides) <= {"right", "left"}:
        raise TrackerError(f"--sides {text!r}: needed right, left or right,left.")
    return sides
